"""Every source of uncertainty of n sensors that share a resin and a printer."""

from collections.abc import Mapping

import numpy as np

from pneutouch.arrays import Flags
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import UncertaintySource
from pneutouch.mechanics.uncertainty.sources.build import build_sources
from pneutouch.mechanics.uncertainty.sources.model import ModelErrors, model_sources, numerical_sources
from pneutouch.mechanics.uncertainty.sources.modulus import ageing_sources, modulus_sources
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer


def sources(
    batch: SensorBatch,
    material: Material,
    printer: Printer,
    *,
    near_paper: Flags | bool,
    errors: ModelErrors,
    numerical: Mapping[str, float],
    aged: bool = True,
) -> list[UncertaintySource]:
    """Sources that count for at least one figure of one sensor; see `budget` for the arguments."""
    size = len(batch)
    near = np.broadcast_to(np.asarray(near_paper, dtype=bool), size)
    source_list = [
        *modulus_sources(material, near & bool(errors.resin_errors)),
        *build_sources(batch, printer),
        *(ageing_sources(material, size) if aged else []),
        *model_sources(near, errors),
        *numerical_sources(size, numerical),
    ]
    return [source for source in source_list if source.counts.any()]
