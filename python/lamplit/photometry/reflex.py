# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`ReflexReading`: what a retro-reflector sends back, for one pair of angles."""

from __future__ import annotations

from dataclasses import dataclass


def arc(degrees: float) -> str:
    """Return an angle of observation as regulations write it, to the tenth of a minute.

    >>> arc(1 / 3), arc(1.5), arc(2.0), arc(0.025)
    ('20′', '1°30′', '2°', '1.5′')
    """
    minutes = round(60.0 * degrees, 1)
    whole, rest = divmod(minutes, 60.0)
    return f"{whole:g}°" * bool(whole) + f"{rest:g}′" * bool(rest or not whole)


@dataclass(frozen=True)
class ReflexReading:
    """The coefficient of luminous intensity (CIL) of a retro-reflector.

    The entrance angle lies between the reflector's axis and the light's direction, given as V and
    H like any direction; the observation angle (UN R3: angle of divergence) lies between the light
    and the receiver as the reflector sees them.
    """

    entrance_v_deg: float
    entrance_h_deg: float
    observation_deg: float
    #: Intensity sent back per illuminance on the reflector, in mcd/lx, and its standard error.
    cil_mcd_per_lx: float
    standard_error_mcd_per_lx: float
