"""Content of the measured datasheet: groups of runs, each compared with its prediction."""

from dataclasses import dataclass, field
from pathlib import Path

from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.summary import RunGroup
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
from pneutouch.spec.campaign import Campaign


@dataclass(frozen=True)
class GroupComparison:
    """A group compared with its prediction.

    Attributes:
        group: The runs and their figures.
        label: Title of the resin.
        state: The predicted state at the group's driving pressure; None if there is none.
        uncertainty: Its uncertainty, as `Evaluation.uncertainty` has it for a state.
        predicted: Predicted figures by key of `bench.figure.FIGURES`, with the ends of their 95 % band where known:
            value, low, high.
        why: Reason why there is no prediction; empty if there is one.
        published: Measurements of the paper on this sensor, by key of `bench.figure.FIGURES`.
    """

    group: RunGroup
    label: str
    state: SensorState | None
    uncertainty: UncertaintyRecord
    predicted: dict[str, tuple[float, float | None, float | None]]
    why: str = ""
    published: dict[str, float] = field(default_factory=dict)

    def relative_band(self, figure: str) -> tuple[float, float] | None:
        """Ends of a figure's predicted band over its value; None if it has none."""
        value, low, high = self.predicted.get(figure, (0.0, None, None))
        return None if not value or low is None or high is None else (low / value, high / value)


@dataclass(frozen=True, slots=True)
class Verdict:
    """A requirement of the target against its measurement.

    ``passed`` is None if the interval holds values on both sides of the limit: more specimens would decide.
    """

    what: str
    required: str
    measured: str
    passed: bool | None


@dataclass(frozen=True)
class CampaignReport:
    """A whole campaign.

    Attributes:
        campaign: The campaign file.
        scene: The design that it is compared with.
        folder: Folder of the campaign, as the user gave it.
        comparisons: Groups in the order of resin, age and pressure.
        curves: Every curve read, injections aside.
        failures: Files that are not used, with the message.
        questions: Data that look wrong and were not changed: file or run, and the question.
        verdicts: Of the target, empty without one.
        injections: Figures of leak and injection runs: sensor, name, value, standard error, unit.
        ageing: Change of sensitivity between ages: resin, pressure, age, change in percent with its interval, and what
            the paper measured of this resin in a year, or None.
        model: Model of the predictions.
        input_hash: Of campaign, design and files.
    """

    campaign: Campaign
    scene: ResolvedDesign
    folder: Path
    comparisons: tuple[GroupComparison, ...]
    curves: tuple[MeasuredCurve, ...]
    failures: tuple[tuple[str, str], ...]
    questions: tuple[tuple[str, str], ...]
    verdicts: tuple[Verdict, ...]
    injections: tuple[tuple[str, str, float, float | None, str], ...]
    ageing: tuple[tuple[str, float, str, float, float | None, float | None, float | None], ...]
    model: str
    input_hash: str
