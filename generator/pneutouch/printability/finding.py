"""A finding of a rule: what, where, how far off, and what would fix it."""

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from typing import Any, Literal, get_args

from pneutouch.errors import RuleBrokenError, joined

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Excess:
    """Measured value and the limit that it breaks, both in ``unit`` ("" for a ratio or a count)."""

    measured: float
    limit: float
    unit: str = "mm"

    def document(self) -> dict[str, Any]:
        """The numbers as ``check`` prints them."""
        return {"measured": float(f"{self.measured:.4g}"), "limit": float(f"{self.limit:.4g}"), "unit": self.unit}


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding. ``where`` is a point in the design frame in mm; ``source`` backs the limit."""

    rule: str
    severity: Severity
    body: str
    message: str
    fix: str
    source: str
    where: tuple[float, float, float] | None = None
    excess: Excess | None = None

    @property
    def rank(self) -> int:
        """Place of the severity in a list of findings: errors come first."""
        return get_args(Severity).index(self.severity)

    def document(self) -> dict[str, Any]:
        """The finding as ``check`` prints it."""
        return {
            "rule": self.rule,
            "severity": self.severity,
            "body": self.body,
            "message": self.message,
            "where_mm": None if self.where is None else [round(value, 3) + 0.0 for value in self.where],
            "excess": None if self.excess is None else self.excess.document(),
            "fix": self.fix,
            "source": self.source,
        }


def refuse(findings: Iterable[Finding], file: str | PathLike[str], key: str | None = None, value: Any = None) -> None:
    """Raise RuleBrokenError with all findings that are errors, where there are any; ``key`` is the key that decides."""
    broken = [
        RuleBrokenError(f"{f.rule}: {f.body}: {f.message}", file=file, key=key, value=value, remedy=f.fix)
        for f in findings
        if f.severity == "error"
    ]
    if broken:
        raise joined(broken)
