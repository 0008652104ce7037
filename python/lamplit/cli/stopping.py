# SPDX-License-Identifier: Apache-2.0 OR MIT
"""SIGTERM stops a command as Ctrl-C does: what is done is kept."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from lamplit.engine.image import Image


class Stop:
    """Which signal asked the program to stop, if any."""

    def __init__(self) -> None:
        self.signal_number: int | None = None

    @property
    def exit_code(self) -> int:
        """128 + the signal's number, as a shell reports it; 130 (Ctrl-C) when none was seen."""
        return 128 + (self.signal_number or signal.SIGINT)

    def end_if_empty(self, image: Image) -> None:
        """End the run, and leave older results alone, if nothing of ``image`` is done.

        Raises:
            typer.Exit: With the code of the signal.
        """
        if image.interrupted and image.samples == 0 and not image.xyz.any():
            print("stopped before the first sample was done; nothing is written", file=sys.stderr)
            raise typer.Exit(self.exit_code)

    def end_if_interrupted(self, image: Image) -> None:
        """End the run with the code of the signal if one cut ``image`` short.

        Raises:
            typer.Exit: With the code of the signal.
        """
        if image.interrupted:
            raise typer.Exit(self.exit_code)


@contextmanager
def stop_signals() -> Generator[Stop]:
    """Turn SIGINT and SIGTERM into KeyboardInterrupt, and remember which it was.

    One may stand within another: all of them hear the signal.
    """
    stop = Stop()

    def interrupt(number: int, frame: FrameType | None) -> None:
        stop.signal_number = number
        outer = before[number]
        if callable(outer):
            outer(number, frame)
        raise KeyboardInterrupt

    if threading.current_thread() is not threading.main_thread():
        yield stop
        return
    watched = (signal.SIGINT, signal.SIGTERM)
    before: dict[int, Any] = {number: signal.getsignal(number) for number in watched}
    for number in watched:
        signal.signal(number, interrupt)
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
