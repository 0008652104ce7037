# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a scene to an image: the one room that knows the compiled core."""

from __future__ import annotations

from lamplit.engine.compare import Comparison, compare
from lamplit.engine.cross_check import CrossCheck
from lamplit.engine.features import Features
from lamplit.engine.image import Image
from lamplit.engine.ledger import Ledger
from lamplit.engine.light_sources import BeamLight, RayLight
from lamplit.engine.lumens import LumenLedger
from lamplit.engine.measure import measure
from lamplit.engine.measurement import Measurement
from lamplit.engine.measuring_run import MeasureInterrupted
from lamplit.engine.plan import FIRST_ROUND_SAMPLES, Plan, plan
from lamplit.engine.receivers import Goniometer, Plane
from lamplit.engine.reflectors import ReflexInterrupted, ReflexMeasurement, measure_reflector
from lamplit.engine.render import RenderInterrupted, render
from lamplit.engine.snapshot import Snapshot
from lamplit.engine.views import Views, plan_views, render_views

__all__ = [
    "FIRST_ROUND_SAMPLES",
    "BeamLight",
    "Comparison",
    "CrossCheck",
    "Features",
    "Goniometer",
    "Image",
    "Ledger",
    "LumenLedger",
    "MeasureInterrupted",
    "Measurement",
    "Plan",
    "Plane",
    "RayLight",
    "ReflexInterrupted",
    "ReflexMeasurement",
    "RenderInterrupted",
    "Snapshot",
    "Views",
    "compare",
    "measure",
    "measure_reflector",
    "plan",
    "plan_views",
    "render",
    "render_views",
]
