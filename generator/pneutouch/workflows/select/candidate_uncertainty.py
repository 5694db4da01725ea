"""The uncertainty of the sensitivity of candidates, as the ranking needs it."""

from collections.abc import Mapping, Sequence

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.models import NUMERICAL
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty import ModelErrors
from pneutouch.mechanics.uncertainty.propagate import Budget, propagate_groups
from pneutouch.mechanics.uncertainty.source import FIGURES, SENSITIVITY, UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.place import PLACE
from pneutouch.selection import CandidateResin


def sensitivity_uncertainties(
    scene: ResolvedDesign,
    sensor: Sensor,
    known: Mapping[str, ModelErrors],
    groups: Sequence[tuple[CandidateResin, SensorBatch]],
    *,
    anywhere: bool = False,
) -> list[Array]:
    """Relative expanded uncertainties of the sensitivity of the designs of each resin, (n,) each.

    ``anywhere`` counts an unknown place of contact; NaN for designs that its table does not cover.
    """
    pool = next(iter(known.values())).pool if known else ()

    def sources_of(resin: CandidateResin, batch: SensorBatch) -> list[UncertaintySource]:
        """Sources of uncertainty of the designs of one resin."""
        return sources(
            batch,
            resin.material,
            scene.printer,
            near_paper=np.array([is_near_paper(sized_as(sensor, batch, i)) for i in range(len(batch))]),
            errors=known.get(resin.name) or ModelErrors(pool=pool),
            numerical={FIGURES[SENSITIVITY]: NUMERICAL["atlas"]},
            anywhere=anywhere,
        )

    budgets = propagate_groups([(batch, sources_of(resin, batch)) for resin, batch in groups])
    return [np.where(_counted(budget, anywhere=anywhere), budget.expanded[SENSITIVITY], np.nan) for budget in budgets]


def _counted(budget: Budget, *, anywhere: bool) -> Flags:
    """Designs for which every source that the target counts is known, (n,)."""
    placed = [source.counts[SENSITIVITY] for source in budget.sources if source.name == PLACE]
    whole = np.ones(budget.expanded.shape[1], dtype=bool)
    return np.asarray(whole if not anywhere else placed[0] if placed else ~whole)


def sized_as(sensor: Sensor, batch: SensorBatch, i: int) -> Sensor:
    """The sensor with the sizes of candidate ``i`` of a batch, without a flange."""
    return sensor.replace(
        inner_radius=float(batch.inner_radius[i]),
        wall_thickness=float(batch.wall_thickness[i]),
        dead_volume=float(batch.dead_volume[i]),
        plate_radius=float(batch.plate_radius[i]),
        flange=None,
    )
