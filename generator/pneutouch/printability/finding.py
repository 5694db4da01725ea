"""A finding of a rule: what, where, how far off, and what would fix it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal, get_args

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Excess:
    """How far off: what was measured and the limit it stands against, both in ``unit`` ("" for a ratio or a count)."""

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


def by_severity(findings: Iterable[Finding]) -> list[Finding]:
    """Errors first, then warnings, then notes; the order within each is kept."""
    return sorted(findings, key=lambda finding: get_args(Severity).index(finding.severity))
