"""Findings of the print rules and estimates of print jobs."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, Self, get_args

from pneutouch.wording import rounded

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Excess:
    """A measured value and the limit that it breaks, both in one unit."""

    measured: float
    """Measured value."""
    limit: float
    """Limit that it breaks."""
    unit: str
    """Unit of both; empty for a ratio or a count."""


@dataclass(frozen=True, slots=True)
class Finding:
    """A finding of a print rule."""

    rule: str
    """Name of the rule."""
    severity: Severity
    """Severity."""
    body: str
    """Name of the body that it is about."""
    message: str
    """Problem, in words."""
    fix: str
    """Remedy."""
    source: str
    """Source of the limit."""
    where_mm: tuple[float, float, float] | None
    """Place in the design frame; null: the whole body."""
    excess: Excess | None
    """Measured value and limit; null: the finding has no number."""

    @property
    def rank(self) -> int:
        """Order of the severity in a list of findings: errors, then warnings, then notes."""
        return get_args(Severity).index(self.severity)

    @property
    def stated(self) -> Self:
        """The finding with its numbers rounded as documents state them."""
        x, y, z = self.where_mm or (0.0, 0.0, 0.0)
        where_mm = None if self.where_mm is None else (round(x, 3) + 0.0, round(y, 3) + 0.0, round(z, 3) + 0.0)
        excess = self.excess
        if excess is not None:
            # Counts are whole numbers; a document states them as every other value.
            excess = rounded(Excess(float(excess.measured), float(excess.limit), excess.unit), 4)
        return replace(self, where_mm=where_mm, excess=excess)


@dataclass(frozen=True, slots=True)
class TrayFinding(Finding):
    """A finding of a print rule on a part of a tray, and on all parts of its shape."""

    labels: tuple[str, ...]
    """Labels of all parts of the same shape."""

    @property
    def parts(self) -> str:
        """The first label, with the number of further ones."""
        return self.labels[0] if len(self.labels) == 1 else f"{self.labels[0]} and {len(self.labels) - 1} more"

    @property
    def text(self) -> str:
        """One line: severity, parts, rule, problem and remedy."""
        return f"{self.severity}: {self.parts}: {self.rule}: {self.message}; {self.fix}"


@dataclass(frozen=True, slots=True)
class ItemEstimate:
    """A body of a job; its volume is that of the exact solid where there is one."""

    name: str
    """Name of the body."""
    volume_mL: float
    """Volume of the body."""
    mass_g: float
    """Mass of the body, with its infill."""
    resins_mL: Mapping[str, float]
    """Resins by name; those of a digital material without a measured mix together."""


@dataclass(frozen=True, slots=True)
class JobEstimate:
    """Resin and time of a print job, or of a casting, which has no layers."""

    job: str
    """Name of the job."""
    printer: str
    """Title of the printer."""
    mode: str
    """Print mode."""
    items: tuple[ItemEstimate, ...]
    """Bodies of the job."""
    size_mm: tuple[float, float, float]
    """Size of the job as it stands."""
    resins_mL: Mapping[str, float]
    """Resins of all bodies by name."""
    support_mL: float | None
    """Volume of the support material; null: the printer's own program lays it."""
    layers: int | None
    """Number of layers; null: it is cast."""
    swaths: int | None
    """Number of swaths of the heads; null: there are none, or their width is not known."""
    time_min: float | None
    """Time of the print, or of the cure; null: the profile does not state enough."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""
