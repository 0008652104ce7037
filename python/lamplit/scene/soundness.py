# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`check_scene`: everything that is, or may be, wrong with a scene, in one list."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

from lamplit.errors import SceneError
from lamplit.scene.contact import Contact, find_contacts
from lamplit.scene.eyes import seen_from
from lamplit.scene.memory import MemoryEstimate, memory_estimate
from lamplit.scene.models import Scene
from lamplit.scene.rays import ray_faults, ray_notices
from lamplit.scene.references import values_of
from lamplit.scene.resolve import ResolvedObject, solid_faults
from lamplit.scene.shining import light_faults, path_notices
from lamplit.scene.solids import Body, bodies
from lamplit.scene.spectra import spectral_faults
from lamplit.scene.view import view_fault, views_fault
from lamplit.spectra_spec import NamedSource
from lamplit.table_faults import key_path

Level: TypeAlias = Literal["error", "warning", "notice"]


@dataclass(frozen=True)
class Finding:
    """One thing to know: ``subject`` is an object's name or a key path."""

    level: Level
    subject: str
    message: str


@dataclass(frozen=True)
class Report:
    """What `check_scene` found, errors first, and the memory that rendering will take."""

    findings: tuple[Finding, ...]
    memory: MemoryEstimate

    @property
    def sound(self) -> bool:
        """Whether the scene can be rendered: nothing found is an error."""
        return all(finding.level != "error" for finding in self.findings)


def check_scene(scene: Scene) -> Report:
    """Return what is wrong with ``scene``, and what was put right in its meshes.

    Raises:
        LamplitError: A mesh cannot be read at all.
    """
    everything = bodies(scene)
    found = [
        *_errors(scene),
        *(finding for body in everything for finding in _mesh_findings(body)),
        *_contacts(everything),
        *_unused(scene),
    ]
    if not any(finding.subject.startswith("ray_files") for finding in found):
        found += [Finding("notice", "ray_files", notice) for notice in ray_notices(scene)]
    if not any(finding.subject == "background.file" for finding in found):
        found += _path_findings(scene)
    order = ("error", "warning", "notice")
    found.sort(key=lambda finding: order.index(finding.level))
    return Report(tuple(found), memory_estimate(scene))


def _errors(scene: Scene) -> Iterator[Finding]:
    faults = [
        *spectral_faults(scene),
        *solid_faults(scene),
        *light_faults(scene),
        *ray_faults(scene),
    ]
    if (unseen := view_fault(scene)) is not None:
        faults.append(unseen)
    if scene.eyes and (unseen := views_fault(seen_from(scene, scene.eyes), where="eyes")):
        faults.append(unseen)
    for fault in faults:
        yield Finding("error", fault.where or scene.name, fault.message)


def _path_findings(scene: Scene) -> Iterator[Finding]:
    if scene.image.method == "hall":
        return
    try:
        for notice in path_notices(scene):
            yield Finding("notice", "image.method", notice)
    except SceneError as fault:
        yield Finding("error", fault.where or scene.name, fault.message)


def _mesh_findings(body: Body) -> Iterator[Finding]:
    thing, mesh = body.thing, body.thing.mesh
    for notice in thing.notices:
        yield Finding("notice", thing.name, notice)
    if mesh is None:
        return
    if not mesh.closed and not thing.transparent:
        yield Finding(
            "notice",
            thing.name,
            f"the mesh is open ({mesh.open_edges} edges lack a triangle): seen as a thin surface",
        )
    low, high = body.bounds
    size = float(max(high - low))
    if not 0.01 <= size <= 100_000.0:
        yield Finding("warning", thing.name, f"the mesh is {size:.3g} mm large: is its unit right?")


def _contacts(everything: tuple[Body, ...]) -> Iterator[Finding]:
    contacts, skipped = find_contacts(everything)
    for contact in contacts:
        yield _told(contact, everything[contact.first].thing, everything[contact.second].thing)
    if skipped:
        yield Finding(
            "warning", "objects", f"{skipped} more pairs of near objects were not looked at"
        )


def _unused(scene: Scene) -> Iterator[Finding]:
    used = {
        "materials": {thing.material for thing in scene.objects},
        "sources": {
            source.root
            for keys, source in values_of(scene, NamedSource)
            if keys[0] != "sources"  # these name the library
        },
    }
    for table, entries in (("materials", scene.materials), ("sources", scene.sources)):
        for name in entries:
            if name not in used[table]:
                yield Finding("notice", key_path((table, name)), f"nothing uses {name!r}")


def _told(contact: Contact, first: ResolvedObject, second: ResolvedObject) -> Finding:
    """Return what to say of a contact: who wins, or that nobody said who does."""
    names = f"{first.name!r} and {second.name!r}"
    looked = f"{contact.points} points looked at"
    if contact.kind == "touch":
        return Finding("notice", first.name, f"{names} touch: within 1 µm ({looked})")
    if contact.kind == "overlap":
        what = f"{names} overlap, about {contact.depth_mm:.3g} mm deep"
    else:
        inner, outer = (first, second) if contact.kind.startswith("first") else (second, first)
        what = f"{inner.name!r} lies inside {outer.name!r}"
        if inner.priority < outer.priority:
            return Finding(
                "warning",
                inner.name,
                f"{what}, whose priority is higher: it will not be seen; raise its priority",
            )
    if first.priority != second.priority:
        winner = first if first.priority > second.priority else second
        return Finding("notice", first.name, f"{what}; {winner.name!r} wins by priority ({looked})")
    if not (first.transparent or second.transparent):
        return Finding("notice", first.name, f"{what} ({looked})")
    return Finding(
        "warning",
        first.name,
        f"{what}, and both have priority {first.priority}: give the one that fills the common "
        f"space the higher priority ({looked})",
    )
