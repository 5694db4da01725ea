"""Designs, builds and measurements side by side: their differences, and their figures with intervals."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.api import show
from pneutouch.api.design import Design, pressures_changed
from pneutouch.api.fields import keywords, named_by_keyword
from pneutouch.api.prediction import Prediction
from pneutouch.errors import InputError
from pneutouch.mechanics.models.choice import model_options
from pneutouch.report import comparison_words
from pneutouch.results.comparison import ComparisonRecord, RowRecord
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.spec.design import DesignFile
from pneutouch.workflows.compare import CompareResult, write
from pneutouch.workflows.compare import compare as run

if TYPE_CHECKING:
    from pandas import DataFrame


class Comparison(show.Documented):
    """Columns side by side. ``inputs`` maps each field that differs to its values, one for each column; ``predictions``
    are those of the designs, ``designs`` the `Design` objects that were given."""

    def __init__(self, result: CompareResult, designs: tuple[Design, ...] = ()) -> None:
        self._result, self.designs = result, designs
        self.predictions = tuple(Prediction(e) for e in result.evaluations if e is not None)
        names = {field: keyword for keyword, field in keywords(DesignFile).items()}
        self.inputs = {names.get(key, key): values for key, values in result.record.inputs.items()}

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the columns, all different."""
        return tuple(comparison_words.labels(self._result.record))

    def to_frame(self) -> "DataFrame":
        """Table with a row for each figure and driving pressure (None: of the whole sensor); columns ``value``,
        ``low``, ``high`` by label, and for the difference from the first ``percent``, its two ends and ``exceeds``."""
        from pandas import DataFrame, MultiIndex

        rows = self._result.record.figures
        index = MultiIndex.from_tuples(
            [(row.driving_pressure_kPa, row.figure) for row in rows], names=["driving_pressure_kPa", "figure"]
        )
        columns: dict[tuple[str, str], list[Any]] = {}
        for k, label in enumerate(self.labels):
            for key in ("value", "low", "high"):
                values = [row.values[k] for row in rows]
                columns[label, key] = [None if one is None else getattr(one, key) for one in values]
        for k, label in enumerate(self.labels[1:]):
            for key in ("percent", "low_percent", "high_percent", "exceeds"):
                entries = [row.differences[k] for row in rows]
                columns[label, key] = [None if one is None else getattr(one, key) for one in entries]
        return DataFrame(columns, index)

    def _document(self) -> ComparisonRecord:
        return self._result.record

    def write(self, out: str | Path = "outputs") -> Path:
        """Write the comparison as HTML, PDF and JSON into a folder of ``out``; returns that folder."""
        return write(self._result, Path(out))

    @property
    def _columns(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("", *self.labels, *(f"{label}, difference" for label in self.labels[1:]))

    def _rows(self) -> list[Any]:
        inputs = [(key, *(show.short(value) for value in values)) for key, values in self.inputs.items()]
        figures = sorted(self._result.record.figures, key=lambda row: row.figure != SENSITIVITY_KEY)
        return [*inputs, *(self._row(row) for row in figures)]

    def _row(self, row: RowRecord) -> tuple[str, ...]:
        at = "" if row.driving_pressure_kPa is None else f" {comparison_words.heading(row.driving_pressure_kPa)}"
        values = [f"{value} ({ends})" if ends else value for value, ends in comparison_words.figure_cells(row)]
        return (f"{row.name}{at}", *values, *(f"{p}, {word}" for p, _, word in comparison_words.difference_cells(row)))

    def _head(self) -> str:
        return f"Comparison of {', '.join(self.labels)}"


def compare(
    *things: Design | str | Path,
    driving_pressures_kPa: float | Iterable[float] | None = None,
    model: str | None = None,
    tolerance: float | str | None = None,
    closure: str = "variational",
    clamp: str = "base",
    aged: bool = False,
) -> Comparison:
    """Set designs (objects, names, files), folders of builds and folders of measured results side by side.

    ``driving_pressures_kPa`` apply to all designs (None: their own); else as `Design.predict`. Raises InputError.
    """
    if not things:
        raise InputError("no design to compare", key="designs", remedy="give designs, their names or their paths")
    changed, options = pressures_changed(driving_pressures_kPa), model_options(model, tolerance)
    given = [thing.source if isinstance(thing, Design) else str(thing) for thing in things]
    with named_by_keyword():
        result = run(given, changed, closure=closure, clamp=clamp, aged=aged, **options)
    return Comparison(result, tuple(thing for thing in things if isinstance(thing, Design)))
