"""The section "Uncertainty" of a datasheet: its tables of intervals, sources and model, and the chart of shares."""

from collections.abc import Mapping, Sequence
from typing import Any

from pneutouch.arrays import grouped
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.prediction import SensorPrediction
from pneutouch.report.blocks import Columns, Items, Plot, SheetBlock, SheetTable, Text, section
from pneutouch.report.style import ACCENT, BOLD, INK, MUTED, figure, svg
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.results.uncertainty import SourceRecord, UncertaintyRecord
from pneutouch.units import KPA
from pneutouch.wording import data_of

_FIGURES: dict[str, tuple[str, str]] = data_of(__file__)

_ONLY_MODEL = "the contact is not symmetric about the axis, which the other models take it to be"

_PLAIN = ("shear_modulus", "inner_radius", "dead_volume", "ambient_pressure", "driving_pressure")
_INPUTS = {name: name.replace("_", " ") for name in _PLAIN} | {"wall_thickness": "wall"}


def ends(prediction: SensorPrediction, documents: tuple[UncertaintyRecord, ...]) -> dict[str, UncertaintyRecord]:
    """Uncertainties at the lowest and highest driving pressure by label (``7 kPa``), if sensitivity has an interval."""
    pairs = list(zip(prediction.states, documents, strict=True))
    chosen = pairs[:1] + pairs[1:][-1:]
    return {f"{s.driving_pressure / KPA:g} kPa": d for s, d in chosen if SENSITIVITY_KEY in d.known}


def interval(document: UncertaintyRecord, figure: str = SENSITIVITY_KEY) -> str:
    """The k = 2 interval of a figure, such as ``1.57 to 2.38``; empty if unknown."""
    estimate = document.known.get(figure)
    return "" if estimate is None else f"{_digits(estimate.low)} to {_digits(estimate.high)}"


def shares(covered: dict[str, UncertaintyRecord]) -> dict[str, dict[str, float]]:
    """Shares of the sources in the variance of the sensitivity, by label of the driving pressure."""
    return {label: dict(document.known[SENSITIVITY_KEY].shares) for label, document in covered.items()}


def uncertainty_section(sheet: SheetData, plots: Sequence[Plot]) -> list[SheetBlock]:
    """Blocks of the section with ``plots`` in it; without an interval only the reason and the model."""
    documents, model = sheet.uncertainty, SheetTable(model_rows(sheet))
    covered = ends(sheet.prediction, documents)
    if not covered:
        why = next((document.unknown for document in documents if document.unknown is not None), None)
        why = why or "no interval of the sensitivity can be given: the atlas has no state at these driving pressures"
        return section("Uncertainty", Text(f"No interval is given: {why}."), model)
    label, last = list(covered.items())[-1]
    share_of = last.known[SENSITIVITY_KEY].shares
    head = ["Figure", "Unit", *(cell for label in covered for cell in (f"at {label}", "k = 2"))]
    figures = SheetTable(_figures(covered), head, numeric=range(2, len(head)), small=True)
    counted = [source for source in last.sources or () if source.standard_uncertainty > 0]
    rows = [_source(source, share_of) for source in sorted(counted, key=lambda one: -share_of.get(one.name, 0.0))]
    names = ("Source", "Standard\nuncertainty", "Of", f"Share at\n{label}", "Basis", "Where from")
    notes = {label: [_plain(f"{note}.") for note in one.notes or ()] for label, one in covered.items()}
    return section(
        "Uncertainty",
        Items(_by_state({label: [document.summary or ""] for label, document in covered.items()})),
        Columns(((figures,), (model,)), (3, 2)),
        *plots,
        SheetTable(rows, names, numeric=(1, 3)),
        Items(_by_state(notes)),
    )


def _by_state(texts: dict[str, list[str]]) -> list[str]:
    """Sentences, by label of the driving pressure, each once with the pressures that it holds for."""
    labels_of = grouped((text, label) for label, lines in texts.items() for text in lines)
    return [f"At {' and '.join(labels)}: {text[:1].lower()}{text[1:]}" for text, labels in labels_of.items()]


def _plain(text: str) -> str:
    """The text with the keys of figures replaced by the sheet's names for them, and +- by ±."""
    for name, (title, _) in _FIGURES.items():
        text = text.replace(name, title.lower())
    return text.replace("+-", "±")


def _figures(covered: dict[str, UncertaintyRecord]) -> list[list[str]]:
    rows = []
    for name, (title, unit) in _FIGURES.items():
        cells = []
        for document in covered.values():
            figure = document.known.get(name)
            cells += ["–", ""] if figure is None else [_digits(figure.value), _width(document, name)]
        rows.append([title, unit, *cells])
    return rows


def _width(document: UncertaintyRecord, name: str) -> str:
    """The interval of a figure; "as stated" if no source has an effect on it."""
    figure = document.known[name]
    return interval(document, name) if figure.expanded_uncertainty > 0 else "as stated"


def _source(source: SourceRecord, share_of: Mapping[str, float]) -> list[str]:
    """Row on a source: name, standard uncertainty, what it acts on, its share, known or assumed, and its origin."""
    size = source.standard_uncertainty
    value = f"{size:.2g} mL" if source.unit == "mL" else f"{100 * size:.2g} %"
    figures = [_FIGURES[name][0].lower() for name in source.figures]
    acts_on = _INPUTS.get(source.acts_on, ", ".join(figures))
    other = bool(figures) and SENSITIVITY_KEY not in source.figures
    part = "–" if other else _percent(share_of.get(source.name, 0.0))
    return [source.name, value, acts_on, part, "known" if source.known else "assumed", _plain(source.origin)]


def model_rows(sheet: SheetData) -> list[list[str]]:
    """Rows on the model: its name, its numerical error, why it was chosen, and the calibration if there is one."""
    prediction, error = sheet.prediction, sheet.numerical_error
    exact = f"within {error:.1%} in sensitivity"
    if prediction.model == "membrane":
        exact = f"up to {1 + error:.0f} times off the solid's sensitivity"
    usual = _ONLY_MODEL if prediction.model == "harmonic" else "asked for by name, or the default"
    why = prediction.error_estimate.model_choice or usual
    rows = [["Model", prediction.model], ["Numerical error", exact], ["Why this model", why]]
    calibration = sheet.scene.calibration
    if calibration is not None:
        rows.append(["Calibration", f"{sheet.scene.design.calibration}: {calibration.title}; of this specimen alone"])
    return rows


def _digits(value: float) -> str:
    """A number with three significant digits; one from 100 up is rounded to a whole number."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:#.3g}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if share >= 0.005 else "< 1 %"


_MOST = 5
"""Number of sources drawn; the rest is added up in one bar."""

_WIDTH = 105.0
"""Width of the chart in mm: readable on a narrow screen."""

_THICK = 0.4
OTHERS = "all others"


def ranked(shares: list[dict[str, float]]) -> dict[str, list[float]]:
    """Shares by source, one for each state, largest sum first; those after the first `_MOST` added up as `OTHERS`."""
    names = {name for local in shares for name in local}
    order = sorted(names, key=lambda name: (-sum(local.get(name, 0.0) for local in shares), name))
    rows_of = {name: [local.get(name, 0.0) for local in shares] for name in order[:_MOST]}
    if order[_MOST:]:
        rows_of[OTHERS] = [sum(local.get(name, 0.0) for name in order[_MOST:]) for local in shares]
    return rows_of


def uncertainty_shares(sheet: SheetData) -> Plot | None:
    """Bar chart of the shares of the sources in the sensitivity's variance; None without an interval."""
    covered = ends(sheet.prediction, sheet.uncertainty)
    words = "What makes the sensitivity uncertain: shares of its variance. The longest bar is what to measure first."
    return Plot(share_bars(shares(covered)), words, mm=_WIDTH) if covered else None


def share_bars(shares: dict[str, dict[str, float]]) -> str:
    """SVG bar chart of shares of the variance (0 to 1): by label of one or two driving pressures, then by source."""
    rows = ranked(list(shares.values()))
    with figure(_WIDTH, 11 + 3.9 * len(rows) * max(1.4, len(shares))) as drawn:
        ax = drawn.add_subplot()
        for row, values in enumerate(rows.values()):
            for k, (value, label) in enumerate(zip(values, shares, strict=True)):
                height = row + (k - 0.5 * (len(shares) - 1)) * _THICK
                ax.barh(height, 100 * value, _THICK, lw=0.6, color=(ACCENT, "white")[k], ec=INK)
                text = _percent(value)
                place: dict[str, Any] = {"xytext": (3, -0.3), "textcoords": "offset points", "va": "center"}
                place |= {"color": INK, **BOLD} if row == 0 else {"color": MUTED}
                ax.annotate(f"{text}  at {label}" if row == 0 else text, (100 * value, height), fontsize=6.5, **place)
        ax.set_yticks(range(len(rows)), list(rows))
        ax.invert_yaxis()
        ax.grid(False, axis="y")
        ax.tick_params(axis="y", length=0)
        ax.set(xlabel="share of the variance of the sensitivity  (%)", xlim=(0, 100))
        return svg(drawn)
