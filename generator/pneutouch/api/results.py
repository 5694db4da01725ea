"""Results of checks and workflows: data with a short text of itself."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.api import show
from pneutouch.errors import InputError, shown
from pneutouch.printability import Finding
from pneutouch.results.prediction import ByMixingCurve


@dataclass(frozen=True, repr=False)
class CheckResult(show.Documented):
    """The findings of a check, ``passed`` without an error; ``curves``: figures by each mixing curve of a mix."""

    name: str
    findings: tuple[Finding, ...]
    curves: tuple[ByMixingCurve, ...] = ()

    @property
    def passed(self) -> bool:
        """True if no rule is broken."""
        return all(finding.severity != "error" for finding in self.findings)

    def _document(self) -> Any:
        content = {"design": self.name, "passed": self.passed, "findings": [f.stated for f in self.findings]}
        return {**content, "mixing_curves": self.curves} if self.curves else content

    def _head(self) -> str:
        verdict = "passed" if self.passed else "not passed"
        return f"Check of {shown(self.name)}: {verdict}, {len(self.findings)} findings"

    def _rows(self) -> list[Any]:
        return [(f.severity, f.rule, f.body, f.message, f.fix) for f in self.findings]


class Result(show.Shown):
    """The results of a workflow, by key as its command prints them as JSON; `save` writes its folder."""

    def __init__(self, title: str, document: dict[str, Any], write: Callable[[Path], Path] | None = None) -> None:
        self.title, self._document, self._write = title, document, write

    def __getitem__(self, key: str) -> Any:
        return self._document[key]

    def keys(self) -> list[str]:
        """Keys of the results."""
        return list(self._document)

    def to_dict(self) -> dict[str, Any]:
        """The document that the command prints as JSON."""
        return dict(self._document)

    def save(self, out: str | Path = "outputs") -> Path:
        """Write the command's folder into ``out`` and return it. Raises InputError if it is written already."""
        if self._write is None:
            raise InputError(f"{self.title} is written already")
        return self._write(Path(out))

    def _head(self) -> str:
        return self.title

    def _rows(self) -> list[Any]:
        return list(self._document.items())
