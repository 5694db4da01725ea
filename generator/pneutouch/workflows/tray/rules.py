"""The print rules over a tray: each distinct shape once, in the mode of its job, with its mark."""

from dataclasses import dataclass

from pneutouch.parts.lettering.mark import shape_of
from pneutouch.printability import Finding, check
from pneutouch.workflows.tray.lay import TrayLayout
from pneutouch.workflows.tray.subject import subject


@dataclass(frozen=True, slots=True)
class TrayFinding:
    """A finding on a part, and the labels of all parts of the same shape."""

    labels: tuple[str, ...]
    finding: Finding

    @property
    def parts(self) -> str:
        """The labels in short."""
        return self.labels[0] if len(self.labels) == 1 else f"{self.labels[0]} and {len(self.labels) - 1} more"

    @property
    def text(self) -> str:
        """One line: the place, the problem and the remedy."""
        finding = self.finding
        return f"{finding.severity}: {self.parts}: {finding.rule}: {finding.message}; {finding.fix}"


def findings(layout: TrayLayout) -> tuple[TrayFinding, ...]:
    """The findings, errors first. Copies, and resins of one kind in one shape, are judged by the first of them."""
    listed = []
    for job in layout.jobs:
        alike: dict[object, list[int]] = {}
        for k, part in enumerate(job.parts):
            kinds = tuple((shape_of(solid), solid.material.kind) for solid in part.solids)
            alike.setdefault(kinds, []).append(k)
        for places in alike.values():
            labels = tuple(job.parts[k].label for k in places)
            judged = check(subject(job.parts[places[0]], layout.printer, job.mode))
            listed += [TrayFinding(labels, finding) for finding in judged]
    return tuple(sorted(listed, key=lambda one: one.finding.rank))
