"""Thin places against the printer's limits: the common part of the rules on sizes."""

from collections.abc import Iterator

from pneutouch.printability.finding import Excess, Finding, Severity
from pneutouch.printability.measure.thin import FeatureKind, ThinPlace
from pneutouch.printability.subject import Point3
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.spec.printer import FeatureSize

_ALIKE = 0.02
"""Places whose sizes differ by less (mm) and that break the same limit are reported once."""


def compare(view: PrintView, rule: str, kinds: dict[FeatureKind, str], limit: str, fix: str) -> list[Finding]:
    """Findings of a rule: places of ``kinds``, each with its name in words, below a limit of the printer.

    ``fix`` holds where the item gives no hint of its own.
    """
    findings = []
    for part in view.sound:
        feature = part.limit(limit)
        broken = [
            (severity, least, place)
            for place in part.places
            if place.kind in kinds
            and (least := lower(place.size, feature, part.slack(place.size, place.turn))) is not None
            for severity in [severity_of(place.size, feature, part.slack(place.size, place.turn))]
        ]
        for severity, least, places in _alike(broken):
            findings.append(_finding(part, rule, kinds[places[0].kind], severity, least, places, feature.source, fix))
    return findings


def lower(size: float, feature: FeatureSize, slack: float) -> float | None:
    """The limit that a size (mm) is below, the harder one first; None if it is below none."""
    if feature.least is not None and size < feature.least - slack:
        return feature.least
    return feature.recommended if size < feature.recommended - slack else None


def severity_of(size: float, feature: FeatureSize, slack: float) -> Severity:
    """Severity of a size: an error below the machine's least, a warning below the recommended one."""
    return "error" if feature.least is not None and size < feature.least - slack else "warning"


def wording(size: float, limit: float, severity: Severity) -> str:
    """The size against its limit, mm: ``0.45 mm; the machine makes no less than 0.6 mm``."""
    if severity == "error":
        return f"{size:.2f} mm; the machine makes no less than {limit:g} mm"
    return f"{size:.2f} mm; at least {limit:g} mm is recommended"


def _alike(broken: list[tuple[Severity, float, ThinPlace]]) -> Iterator[tuple[Severity, float, list[ThinPlace]]]:
    """Places of one size together; they come narrowest first."""
    left = list(broken)
    while left:
        severity, least, first = left[0]
        same = [
            b for b in left if b[0] == severity and abs(b[2].size - first.size) < _ALIKE and b[2].kind == first.kind
        ]
        yield severity, least, [place for _, _, place in same]
        left = [b for b in left if b not in same]


def _finding(
    part: PrintPart,
    rule: str,
    noun: str,
    severity: Severity,
    limit: float,
    places: list[ThinPlace],
    source: str,
    fix: str,
) -> Finding:
    size = places[0].size
    often = f" ({len(places)} places)" if len(places) > 1 else ""
    text = f"{noun} is {wording(size, limit, severity)}{often}"
    hint = part.item.hints.get(rule, fix)
    return Finding(rule, severity, part.name, text, hint, source, places[0].where, Excess(size, limit))


def spot(where: object) -> Point3:
    """A point as findings carry it."""
    x, y, z = (float(value) for value in where)  # type: ignore[attr-defined]
    return x, y, z
