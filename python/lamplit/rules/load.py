# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a rule file to a `RuleSet`, and from a name such as "un-r148/S1" to a `Rule`."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from pydantic import ValidationError

from lamplit.errors import LamplitError, RuleError, nearest_name
from lamplit.files import resolve_inside
from lamplit.rules.models import RuleFile, rule_schema
from lamplit.rules.rule import Rule, RuleSet
from lamplit.rules.soundness import check_rules
from lamplit.table_faults import table_fault
from lamplit.toml_files import read_toml

_FOLDER = Path(__file__).parent / "library"


def rule_set_names() -> tuple[str, ...]:
    """Return the names of the rule sets that come with Lamplit, sorted."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml") if path.stem != "colours"))


def load_rules(name: str | Path, *, root: Path | None = None) -> RuleSet:
    """Return the rule set ``name``: one of the library, or a file that ends in ``.toml``.

    With ``root``, the folder of a scene, a file must lie in it; a path out of it is refused.

    >>> load_rules("un-r148").entries[:2]
    ('R1', 'R2')

    Raises:
        RuleError: There is no such set, or the file is not sound; one line with file, key path,
            what is wrong and what to do.
    """
    text = str(name)
    if not text.lower().endswith(".toml"):
        if text not in rule_set_names():
            near = nearest_name(text, rule_set_names())
            raise RuleError(
                f"the library has no rules {text[:60]!r}{near or '.'} "
                f"It has {', '.join(rule_set_names())}; a file of your own ends in .toml"
            )
        return _from_library(text)
    if root is None:
        return _read(Path(name), text)
    try:
        file = resolve_inside(root, text)
    except LamplitError as fault:
        raise RuleError(fault.message) from fault
    return _read(file, text)


def find_rule(text: str, *, root: Path | None = None) -> Rule:
    """Return the rule that ``text`` names: "un-r148/S1", or "my-rules.toml/X" below ``root``.

    Options may follow: "un-r148/S2?period=night&mounting=low".

    >>> find_rule("un-r148/S1").title
    'Stop lamp, steady (S1)'

    Raises:
        RuleError: The name is not of this form, or there is no such rule, option or choice.
    """
    path, question, tail = text.partition("?")
    name, slash, entry = path.rpartition("/")
    pairs = [own.partition("=") for own in tail.split("&")] if question else []
    options = {key: choice for key, _, choice in pairs}
    if not slash or not name or not entry or not all(options) or not all(options.values()):
        raise RuleError(
            f"{text[:60]!r} names no rule; write it as un-r148/S1, my-rules.toml/X or "
            "un-r148/S2?period=night"
        )
    if len(options) < len(pairs):
        raise RuleError(f"{text[:60]!r} names an option twice; name it once")
    return load_rules(name, root=root).entry(entry).under(**options)


@cache
def _from_library(name: str) -> RuleSet:
    return _read(_FOLDER / f"{name}.toml", name)


def _read(file: Path, name: str) -> RuleSet:
    written = read_toml(file, noun="rule", error=RuleError)
    if "lamplit_rules" not in written:
        raise RuleError(
            "this key is missing: a rule file begins with lamplit_rules = 1",
            file=file,
            where="lamplit_rules",
        )
    try:
        rules = RuleFile.model_validate(written)
    except ValidationError as fault:
        message, where = table_fault(fault, written, rule_schema())
        raise RuleError(message, file=file, where=where or None) from None
    try:
        check_rules(RuleSet(name, rules))
    except RuleError as fault:
        raise RuleError(fault.message, file=file, where=fault.where) from None
    return RuleSet(name, rules)
