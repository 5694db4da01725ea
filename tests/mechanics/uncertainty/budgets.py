"""Sensors, resin and printer to a budget."""

from __future__ import annotations

from typing import Any

from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty import Budget
from pneutouch.mechanics.uncertainty.propagate import propagate
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer


def budget(batch: SensorBatch, material: Material, printer: Printer, **more: Any) -> Budget:
    return propagate(batch, sources(batch, material, printer, **more), more.get("contact"))
