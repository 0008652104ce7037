# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The command line: ``lamplit COMMAND``. A command's module is imported when it runs."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence

import typer

from lamplit.cli.commands import LazyCommands
from lamplit.errors import LamplitError
from lamplit.printable import printable

#: How a run ends. A shell adds 128 to the number of the signal that stopped a program.
EXIT_SOUND, EXIT_INTERNAL_FAULT, EXIT_BAD_INPUT, EXIT_INTERRUPTED = 0, 1, 2, 130

_TRACEBACK = "LAMPLIT_TRACEBACK"

app = typer.Typer(
    cls=LazyCommands,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    version: bool = typer.Option(False, "--version", help="Say which Lamplit this is."),
) -> None:
    """Show a car's rear lamp in its true colours before the first mould is cut."""
    if version:
        from lamplit import __version__

        typer.echo(f"lamplit {__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    A fault of the input is one line on the error stream and code 2; a result that must not pass
    as one is one line and code 1; so is a fault of Lamplit itself, which shows its traceback when
    ``LAMPLIT_TRACEBACK`` is set; a run that was stopped by Ctrl-C ends with 130.
    """
    try:
        code = app(
            args=None if arguments is None else list(arguments),
            prog_name="lamplit",
            standalone_mode=False,
        )
        return code if isinstance(code, int) else EXIT_SOUND
    except LamplitError as fault:
        return _fail(str(fault), EXIT_BAD_INPUT)
    except typer.TyperException as fault:
        return _fail(f"{fault.format_message()} (lamplit --help tells more)", EXIT_BAD_INPUT)
    except (typer.Abort, KeyboardInterrupt):
        return _fail("stopped", EXIT_INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_INTERNAL_FAULT
    except SystemExit:
        raise
    except BaseException as fault:  # noqa: BLE001  (a panic of the core is not an Exception)
        return _internal_fault(fault)


def _internal_fault(fault: BaseException) -> int:
    if os.environ.get(_TRACEBACK):
        traceback.print_exc()
    kind = type(fault).__name__
    return _fail(
        f"a fault of Lamplit itself, {kind}: {fault}; please report it, "
        f"with the traceback that {_TRACEBACK}=1 shows",
        EXIT_INTERNAL_FAULT,
    )


def _fail(message: str, code: int) -> int:
    print(f"error: {printable(' '.join(message.split()))}", file=sys.stderr)
    return code
