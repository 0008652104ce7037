# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Names from files as they are shown: nothing in them steers a terminal or turns a line round."""

from __future__ import annotations


def printable(text: str) -> str:
    r"""Return ``text`` with each character that cannot be seen written as its escape.

    Such are controls, line breaks, and marks that turn the direction of writing. Spaces stay.

    >>> print(printable("stop\u202e\x1b[2J lamp λ"))
    stop\u202e\x1b[2J lamp λ
    """
    if text.isprintable():
        return text
    return "".join(
        own if own.isprintable() else own.encode("unicode_escape").decode("ascii") for own in text
    )
