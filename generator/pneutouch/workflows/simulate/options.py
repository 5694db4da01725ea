"""The options of a simulation, and the check of them."""

from dataclasses import dataclass, field
from typing import get_args

from pneutouch.bench.simulate import SimulationTruth
from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.models import USUAL
from pneutouch.spec.campaign import CampaignRun, RunKind

KINDS: tuple[str, ...] = get_args(RunKind)
PRESSED = ("steps", "saturation", "loop", "relaxation")
"""Kinds of run with a plate."""

REPEATED = ("steps", "saturation")
"""Kinds that are run as often as the user asks; the others once."""


@dataclass(frozen=True)
class SimulationOptions:
    """Options of a simulation. Pressures in kPa (None: the design's), rate in Hz, ages in days; ``model`` USUAL for the
    solid, or harmonic off the axis.

    ``planned`` are the runs of a plan; specimens, pressures, runs and kinds then follow from them.
    """

    resins: tuple[str, ...] = ()
    specimens: int = 3
    driving_pressures_kPa: tuple[float, ...] | None = None
    runs: int = 3
    kinds: tuple[str, ...] = ("steps", "loop", "relaxation")
    rate: float = 100.0
    seed: int = 0
    model: str = USUAL
    ages_days: tuple[float, ...] = (0.0,)
    parquet: bool = False
    truth: SimulationTruth = field(default_factory=SimulationTruth)
    planned: tuple[CampaignRun, ...] = ()


def check_options(options: SimulationOptions) -> None:
    """Raise InputError for a simulation that is impossible."""
    bounds = (
        ("specimens", options.specimens, 1, 1000),
        ("runs", options.runs, 1, 1000),
        ("rate_Hz", options.rate, 10.0, 1e5),
        *(("driving_pressures_kPa", p, 0.0, 1000.0) for p in options.driving_pressures_kPa or ()),
        *(("ages", a, 0.0, 36_500.0) for a in options.ages_days),
        *((("rest", options.truth.rest, 0.2, 3600.0),) if options.truth.rest is not None else ()),
    )
    for key, value, low, high in bounds:
        if not low <= value <= high:
            raise InputError(f"must be from {low:g} to {high:g}", key=key, value=value)
    for key, values in (
        ("driving_pressures_kPa", options.driving_pressures_kPa),
        ("ages", options.ages_days),
        ("kinds", options.kinds),
    ):
        if values is not None and (not values or len(set(values)) != len(values)):
            raise InputError("must name at least one, and each once", key=key, value=",".join(map(str, values)))
    for kind in options.kinds:
        if kind not in KINDS:
            raise InputError(f"unknown.{nearest(kind, KINDS)}", key="kinds", value=kind)
