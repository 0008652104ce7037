# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What pydantic finds wrong, as one line with the key path and the nearest valid name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias, TypeGuard, cast

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from lamplit.errors import nearest_name

_Schema: TypeAlias = dict[str, Any]
_Keys: TypeAlias = tuple[str | int, ...]

#: Kinds of fault that say most about what the writer meant, first.
_FIRST = ("extra_forbidden", "union_tag_invalid", "union_tag_not_found", "missing")
_LONGEST_VALUE = 60


def table_fault(
    fault: ValidationError, written: Mapping[str, object], schema: _Schema
) -> tuple[str, str]:
    """Return the one message to show for ``fault``, and the key path that it is said of.

    ``written`` are the tables in which it was found, ``schema`` the JSON Schema that they follow.
    """
    errors = fault.errors(include_url=False)
    ranks = [_FIRST.index(e["type"]) if e["type"] in _FIRST else len(_FIRST) for e in errors]
    error = errors[ranks.index(min(ranks))]
    keys = written_keys(error["loc"], written, missing=error["type"] == "missing")
    message, keys = _message(error, keys, _Place(written, schema))
    return message, key_path(keys)


def key_path(keys: Sequence[str | int]) -> str:
    """Return keys as a scene's reader writes them: ``objects[2].material``."""
    path = ""
    for key in keys:
        if isinstance(key, int):
            path += f"[{key}]"
        else:
            plain = key.replace("-", "").replace("_", "").isalnum() and key.isascii()
            short = key if len(key) <= _LONGEST_VALUE else f"{key[:_LONGEST_VALUE]}…"
            shown = short if plain else repr(short)
            path += f".{shown}" if path else shown
    return path


def written_keys(location: Sequence[str | int], written: object, *, missing: bool = False) -> _Keys:
    """Return pydantic's ``location`` without the names of the chosen forms and kinds.

    Such a name stands where the tables ``written`` have no key. With ``missing``, the last part is
    a key that is not there, and stays.
    """
    keys: list[str | int] = []
    here: object = written
    for at, part in enumerate(location):
        if isinstance(part, str) and part.startswith("<"):
            continue
        inside = _child(here, part)
        rest = [key for key in location[at + 1 :] if not str(key).startswith("<")]
        if inside is not _ABSENT and _fits(inside, rest):
            keys.append(part)
            here = inside
        elif at == len(location) - 1 and missing:
            keys.append(part)
    return tuple(keys)


_ABSENT = object()


def _is_table(value: object) -> TypeGuard[Mapping[str, object]]:
    return isinstance(value, Mapping)


def _child(here: object, part: str | int) -> object:
    if _is_table(here) and isinstance(part, str):
        return here.get(part, _ABSENT)
    if isinstance(here, (list, tuple)) and isinstance(part, int):
        items = cast("Sequence[object]", here)
        return items[part] if 0 <= part < len(items) else _ABSENT
    return _ABSENT


def _fits(inside: object, rest: Sequence[str | int]) -> bool:
    """Return whether a location can go on below ``inside``: a table, or nothing left to name."""
    return not rest or isinstance(inside, (Mapping, list, tuple))


_Told: TypeAlias = tuple[str, _Keys]


class _Place(NamedTuple):
    """The tables as they are written, and the JSON Schema that they follow."""

    written: Mapping[str, object]
    schema: _Schema


def _message(error: ErrorDetails, keys: _Keys, place: _Place) -> _Told:
    """Return what to say, and the key path to say it of."""
    kind = error["type"]
    if kind in _TELLERS:
        return _TELLERS[kind](error, keys, place)
    return _plain(error), keys


def _unknown_key(_error: ErrorDetails, keys: _Keys, place: _Place) -> _Told:
    names = _valid_keys(keys[:-1], place)
    key = str(keys[-1]) if keys else ""
    nearest = nearest_name(key, names)
    known = "" if nearest or not names else f"; the keys here are {', '.join(sorted(names))}"
    return f"unknown key {key[:_LONGEST_VALUE]!r}{nearest}{known}", keys


def _missing(_error: ErrorDetails, keys: _Keys, place: _Place) -> _Told:
    if keys and isinstance(keys[-1], int):
        return f"the list is too short: it has {keys[-1]} entries", keys[:-1]
    return "this key is missing" + _meaning(keys, place), keys


def _unknown_kind(error: ErrorDetails, keys: _Keys, _place: _Place) -> _Told:
    context = error.get("ctx", {})
    names = [name.strip("'") for name in str(context["expected_tags"]).split(", ")]
    tag = str(context["tag"])
    nearest = nearest_name(tag, names) or f"; one of {', '.join(names)} is expected"
    key = str(context["discriminator"]).strip("'")
    return f"unknown {key} {tag[:_LONGEST_VALUE]!r}{nearest}", (*keys, key)


def _no_kind(error: ErrorDetails, keys: _Keys, _place: _Place) -> _Told:
    key = str(error.get("ctx", {})["discriminator"]).strip("'")
    return "this key is missing", (*keys, key)


def _other_word(error: ErrorDetails, keys: _Keys, _place: _Place) -> _Told:
    expected = str(error.get("ctx", {})["expected"])
    names = [name.strip("'") for name in expected.replace(" or ", ", ").split(", ")]
    nearest = nearest_name(str(error["input"]), names) if len(names) > 1 else ""
    return f"{_shown(error)} is not {expected}{nearest}", keys


def _text_length(error: ErrorDetails, keys: _Keys, _place: _Place) -> _Told:
    most = error.get("ctx", {}).get("max_length")
    return "a text is expected" + (f" of at most {most} characters" if most else " here"), keys


def _too_long(error: ErrorDetails, keys: _Keys, _place: _Place) -> _Told:
    context = error.get("ctx", {})
    found, most = context["actual_length"], context["max_length"]
    return f"{found} entries are given, and {most} at most are expected", keys


_TELLERS = {
    "extra_forbidden": _unknown_key,
    "literal_error": _other_word,
    "missing": _missing,
    "string_too_long": _text_length,
    "string_too_short": _text_length,
    "too_long": _too_long,
    "union_tag_invalid": _unknown_kind,
    "union_tag_not_found": _no_kind,
}


def _plain(error: ErrorDetails) -> str:
    kind, message = error["type"], error["msg"]
    if kind == "value_error":
        return message.removeprefix("Value error, ")
    if not message.startswith("Input should"):
        return message
    wish = message.removeprefix("Input should ").removeprefix("be ")
    wish = wish.replace("a valid tuple", "a list in square brackets")
    wish = wish.replace("a valid dictionary or instance of", "a table:")
    wish = wish.replace("a valid", "a").replace("a integer", "a whole number")
    if wish.startswith(("greater", "less")):
        wish = f"a number {wish}"
    return f"{_shown(error)} is given, and what is expected is {wish}"


def _shown(error: ErrorDetails) -> str:
    """Return the faulty value, short; a table or a list by its kind alone."""
    value = error["input"]
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        return f"a list of {len(cast('Sequence[object]', value))}"
    try:
        text = repr(value)
    except ValueError:
        return "a number with too many digits"
    return text if len(text) <= _LONGEST_VALUE else f"{text[:_LONGEST_VALUE]}…"


def _valid_keys(keys: Sequence[str | int], place: _Place) -> set[str]:
    """Return the keys that the table at ``keys`` may have."""
    names: set[str] = set()
    for schema in _schemas_at(keys, place):
        names |= set(schema.get("properties", {}))
    return names


def _meaning(keys: _Keys, place: _Place) -> str:
    for schema in _schemas_at(keys[:-1], place):
        text = schema.get("properties", {}).get(keys[-1], {}).get("description")
        if text:
            return f": {text}"
    return ""


def _schemas_at(keys: Sequence[str | int], place: _Place) -> list[_Schema]:
    """Return every schema that the value at ``keys`` may follow, narrowed by its ``kind``."""
    here: object = place.written
    schemas = list(_forms(place.schema, here, place.schema))
    for key in keys:
        inside = _child(here, key)
        below: list[_Schema] = []
        for schema in schemas:
            if isinstance(key, int):
                options = [*schema.get("prefixItems", [])[key : key + 1], schema.get("items")]
            else:
                options = [
                    schema.get("properties", {}).get(key),
                    schema.get("additionalProperties"),
                ]
            below += [option for option in options if isinstance(option, dict)]
        schemas = [form for schema in below for form in _forms(schema, inside, place.schema)]
        here = inside
    return schemas


def _forms(schema: _Schema, value: object, root: _Schema) -> Iterator[_Schema]:
    """Yield the alternatives of ``schema``, references followed, that fit the ``kind`` of value."""
    if "$ref" in schema:
        name = str(schema["$ref"]).rpartition("/")[2]
        yield from _forms(root["$defs"][name], value, root)
        return
    kind = value.get("kind") if _is_table(value) else None
    chosen = schema.get("discriminator", {}).get("mapping", {})
    if isinstance(kind, str) and kind in chosen:
        yield from _forms({"$ref": chosen[kind]}, value, root)
        return
    options = [*schema.get("anyOf", []), *schema.get("oneOf", [])]
    for option in options:
        for form in _forms(option, value, root):
            own_kind = form.get("properties", {}).get("kind", {}).get("const")
            if kind is None or own_kind is None or own_kind == kind:
                yield form
    if not options:
        yield schema
