# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The list of commands, known by name and by one line before any of them is imported."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup

from lamplit.errors import LamplitError, nearest_name

#: Each command is the function of its own name in ``lamplit.cli.<name>``.
COMMANDS = {
    "render": "Picture of the lamp: PNG, float EXR and numbers.",
    "compare": "RGB against spectral, side by side, with the colour differences.",
    "develop": "Another exposure, tone, display, false colours or glare of a picture.",
    "mix": "Lit, unlit, dimmed: weigh and add the light groups of a render.",
    "measure": "Candela, colour and verdict of the lamp: tables, IES, plots.",
    "report": "One self-contained HTML page: verdict, test points, plots.",
    "check": "Is this scene sound: meshes, overlaps, spectra, memory.",
    "lamp": "Write a parametric example lamp to start from.",
    "materials": "What the library holds, with its references.",
    "sources": "Light sources by name, with their references.",
}


class LazyCommands(TyperGroup):
    """A group that imports a command only to run it or to show its own help.

    ``lamplit --help`` must start in 0.3 s: typer without its rich help takes 0.08 s, numpy alone
    would take 0.13 s more.
    """

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the commands in the order of the help page."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return the command ``cmd_name``.

        Raises:
            LamplitError: There is no such command.
        """
        if cmd_name not in COMMANDS:
            raise LamplitError(
                f"there is no command {cmd_name!r}{nearest_name(cmd_name, COMMANDS)}; "
                f"there are {', '.join(COMMANDS)}"
            )
        function = getattr(import_module(f"lamplit.cli.{cmd_name}"), cmd_name)
        single = typer.Typer(add_completion=False, rich_markup_mode=None)
        single.command(cmd_name, context_settings={"help_option_names": ["-h", "--help"]})(function)
        return typer.main.get_command(single)

    def invoke(self, ctx: Any) -> Any:
        """Run a command; say so where a signal ends it before it has anything to keep.

        Raises:
            Exit: With 130, after Ctrl-C.
        """
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            print("stopped; nothing is written", file=sys.stderr)
            raise typer.Exit(130) from None

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))
