# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The options that several commands share."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated

import typer


class Method(str, Enum):
    """The transports there are."""

    auto = "auto"
    path = "path"
    lit = "lit"
    hall = "hall"


class DisplayName(str, Enum):
    """The displays known by name."""

    srgb = "srgb"
    display_p3 = "display-p3"
    rec2020 = "rec2020"


class Bits(str, Enum):
    """Bits per channel of a PNG."""

    eight = "8"
    sixteen = "16"


SceneArgument = Annotated[
    Path, typer.Argument(metavar="SCENE", help="The scene's TOML file, or the folder it lies in.")
]
OutputOption = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="Where the results go.")
]
MethodOption = Annotated[
    Method | None,
    typer.Option("--method", help="Transport, instead of the scene's: physical, or the founding."),
]
SamplesOption = Annotated[
    int | None, typer.Option("--samples", min=1, help="Samples per pixel, instead of the scene's.")
]
SeedOption = Annotated[
    int | None, typer.Option("--seed", min=0, help="Seed, instead of the scene's.")
]
SizeOption = Annotated[
    str | None,
    typer.Option("--size", metavar="WxH", help="Pixels, such as 640x400, instead of the scene's."),
]
ThreadsOption = Annotated[
    int | None,
    typer.Option(
        "--threads", min=1, max=1024, help="Threads, 1 to 1024; the results do not depend on them."
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Any value of the scene; may be repeated."),
]
DisplayOption = Annotated[
    DisplayName | None, typer.Option("--display", help="Display, instead of the scene's.")
]
AllowLostOption = Annotated[
    bool,
    typer.Option(
        "--allow-lost", help="Let a picture pass although more than 1 % of its rays are lost."
    ),
]
BitsOption = Annotated[Bits, typer.Option("--bits", help="Bits per channel of the PNG.")]
GamutMaskOption = Annotated[
    bool, typer.Option("--gamut-mask", help="Also draw which pixels the display cannot show.")
]
