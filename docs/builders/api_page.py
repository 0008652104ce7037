# SPDX-License-Identifier: Apache-2.0 OR MIT
"""docs/api.md: the public names of Lamplit with their signatures and docstrings."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import Any

import lamplit as ll

_HEAD = """# Python API

Made by `make docs` from the docstrings. Everything here is a name of `lamplit`:
`import lamplit as ll`.
"""

_LINE = 88
_ATTRIBUTES: tuple[type, ...] = (property, cached_property)


def api_page() -> str:
    """Return the text of the page."""
    return "\n".join([_HEAD, *(_entry(name) for name in ll.__all__ if not name.startswith("_"))])


def _entry(name: str) -> str:
    thing = getattr(ll, name)
    is_class = inspect.isclass(thing)
    head = _class_line(name, thing) if is_class else name + _arguments(thing, len(name))
    parts = [f"## {name}", f"```python\n{head}\n```", _prose(thing)]
    if is_class:
        parts += [_fields(thing), *_members(thing)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _class_line(name: str, kind: type) -> str:
    bases = ", ".join(base.__name__ for base in kind.__bases__ if base.__module__ == "builtins")
    return f"class {name}" if bases in ("", "object") else f"class {name}({bases})"


def _fields(kind: type) -> str:
    """Return the fields of a dataclass as a list, each with the comment that explains it."""
    if not is_dataclass(kind):
        return ""
    source = inspect.getsource(kind)
    lines: list[str] = []
    for field in fields(kind):
        comment = re.search(rf"((?:^ +#: .*\n)+) +{field.name}:", source, re.MULTILINE)
        words = "" if comment is None else ": " + " ".join(comment[1].replace("#:", "").split())
        lines.append(f"- `{field.name}: {field.type}`{_prose_of(words)}")
    return "\n".join(lines)


def _members(kind: type) -> Iterator[str]:
    """Yield what a class says of its own public methods and properties, in their order."""
    for name, value in vars(kind).items():
        if name.startswith(("_", "model_")) or not inspect.getdoc(value):
            continue
        if isinstance(value, _ATTRIBUTES):
            yield f"**`.{name}`** {_prose(value)}"
        elif isinstance(value, staticmethod) or inspect.isfunction(value):
            function: Any = value.__func__ if isinstance(value, staticmethod) else value
            call = f"{name}{_arguments(function, len(name))}"
            yield f"```python\n.{call}\n```\n\n{_prose(function)}"


class _Bare:
    """An annotation that is shown as it was written."""

    def __init__(self, text: object) -> None:
        self._text = text

    def __repr__(self) -> str:
        return str(self._text)


def _arguments(function: Callable[..., object], indent: int) -> str:
    signature = inspect.signature(function)
    kept = [
        value.replace(annotation=_Bare(value.annotation))
        for key, value in signature.parameters.items()
        if key != "self"
    ]
    returned = _Bare(signature.return_annotation)
    text = str(signature.replace(parameters=kept, return_annotation=returned))
    if indent + len(text) <= _LINE:
        return text
    one_line = str(inspect.Signature(kept))[1:-1]
    pieces = re.split(r", (?=\w+:|\*,)", one_line)
    return "(\n" + "".join(f"    {piece},\n" for piece in pieces) + f") -> {returned}"


def _prose(thing: object) -> str:
    return _prose_of(inspect.getdoc(thing) or "")


def _prose_of(text: str) -> str:
    """Return a docstring as Markdown: code, examples and exceptions marked as such."""
    text = re.sub(r"``([^`]+)``", r"`\1`", text)
    text = re.sub(r"(?m)^(>>> .*(?:\n(?!\n).*)*)", r"```python\n\1\n```", text)
    return re.sub(r"(?m)^Raises:\n((?:    .*\n?)+)", _raises, text)


def _raises(match: re.Match[str]) -> str:
    lines = re.split(r"\n(?=\S)", textwrap.dedent(match[1]).strip())
    told = (re.sub(r"^(\w+):", r"`\1`:", " ".join(line.split())) for line in lines)
    return "Raises:\n\n" + "\n".join(f"- {line}" for line in told)
