"""Files of tension, planar and equibiaxial tests, read and checked: stretch and nominal stress, in order, in units that
an elastomer can have; and of discs clamped at their rim and inflated, whose pole is stretched equibiaxially."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.tensile.law_fit import LawForm, TensionCurve, fit_law
from pneutouch.errors import InputError
from pneutouch.spec.material import STIFFEST_ELASTOMER_MPA
from pneutouch.tables.layout import TableLayout
from pneutouch.tables.read import layout_of, whole
from pneutouch.tables.text import head_lines
from pneutouch.tables.unit_words import BRACKETS, UNITS, unit_of
from pneutouch.wording import data_of

_DATA = data_of(__file__)
_WORDS, _KINDS = _DATA["words"], _DATA["kinds"]
_TRUE, _NOMINAL, _PERCENT, _PLAIN = (_DATA["others"][key] for key in ("true", "nominal", "percent", "plain"))
_STRESS_WORDS = {"n/mm2": 1.0, "n/mm²": 1.0, "n/mm^2": 1.0}

_STRETCHES = ("stretch", "strain")
_PAIRS = ((_STRETCHES, "stress"), (_STRETCHES, "force"), (("travel",), "force"), (_STRETCHES, "pressure"))
"""Kinds of length column, and the kind of load column that each needs, the best pair first."""

NAMES = "Engineering Strain, Engineering Stress (MPa)"
"""Column names that are understood, for messages."""


class TensileColumn(NamedTuple):
    """A column: name, kind (a key of `_WORDS`), ``true`` for true strain or stress (else nominal), ``stated`` if its
    name says which of the two.

    ``factor`` converts its numbers to 1, mm, MPa or N; None if its name gives no unit."""

    name: str
    kind: str
    true: bool
    stated: bool
    factor: float | None


class ColumnPair(NamedTuple):
    """A column of length (stretch, strain or travel) and a column of load (stress or force)."""

    length: TensileColumn
    load: TensileColumn


def column_pairs(names: Sequence[str], units: Sequence[str], file: str) -> list[ColumnPair]:
    """Pairs of columns in a file, the best first: nominal before true, stress before force.

    Raises InputError if there is none, where a stress states no unit, or a unit does not belong to its quantity."""
    known = [column for pair in zip(names, units, strict=True) if (column := _column(*pair, file)) is not None]
    pairs = []
    for true in (False, True):
        for kinds, load in _PAIRS:
            lengths = [one for one in known if one.kind in kinds and one.true == true]
            loads = [one for one in known if one.kind == load and one.true == (true and load == "stress")]
            if lengths and loads:
                pairs.append(ColumnPair(_only(lengths, file), _only(loads, file)))
    lengths = [one for one in known if one.kind in ("strain", "stretch")]
    loads = [one for one in known if one.kind == "stress"]
    if not pairs and lengths and loads:
        # One of them is true and the other nominal, or the one does not state it.
        raise InputError(
            f"column {lengths[0].name} and column {loads[0].name}: one is true, the other is not named so",
            file=file,
            remedy=f"name both, as {NAMES}, or True Strain, True Stress (MPa)",
        )
    if not pairs:
        problem = f"no columns of stretch and stress among {', '.join(name for name in names if name)}"
        raise InputError(problem, file=file, remedy=f"name them, as {NAMES}; or Extension (mm), Force (N)")
    return pairs


def _only(columns: list[TensileColumn], file: str) -> TensileColumn:
    if len(columns) > 1:
        named = " and ".join(f"{one.name}" for one in columns)
        raise InputError(f"columns {named}: which of them is the {columns[0].kind}?", file=file, remedy="leave one")
    return columns[0]


def _column(name: str, unit: str, file: str) -> TensileColumn | None:
    label, stated = (name, unit.strip("()[] ")) if unit.strip() else _parted(name)
    words = [word for word in re.split(r"[^\w.]+|_", label.lower()) if word]
    kind = next((kind for kind, known in _WORDS.items() if any(word in known for word in words)), None)
    if kind is None or any(word in ("rate", "speed", "time") for word in words):
        return None
    true = any(word in _TRUE for word in words)
    return TensileColumn(name, kind, true, true or any(w in _NOMINAL for w in words), _factor(name, kind, stated, file))


def _parted(name: str) -> tuple[str, str]:
    """Label and unit of a header; the unit is in brackets, or the last part if that is a unit."""
    brackets = list(BRACKETS.finditer(name))
    if brackets:
        last = brackets[-1]
        return f"{name[: last.start()]} {name[last.end() :]}".strip(), last[1].strip() or "-"
    head, mark, tail = name.strip().replace("_", " ").rpartition(" ")
    known = unit_of(tail) is not None or tail.lower() in (*_PERCENT, *_STRESS_WORDS)
    return (head, tail) if mark and known else (name, "")


def _factor(name: str, kind: str, unit: str, file: str) -> float | None:
    if kind in ("strain", "stretch"):
        if unit.lower() in _PERCENT:
            return 0.01
        if unit.lower() in _PLAIN:
            return 1.0 if unit else None
        raise InputError(f"{unit}: no unit of a {kind}", file=file, key=f"column {name}", remedy="give none, or %")
    channel = {"stress": "pressure", "pressure": "pressure", "force": "force"}.get(kind, "position")
    known = unit_of(unit) if unit else None
    if kind == "stress" and unit.lower() in _STRESS_WORDS:
        return _STRESS_WORDS[unit.lower()]
    if known is not None and known[0] == channel:
        return UNITS[channel][known[1]]
    right = {"stress": "MPa, kPa or psi", "pressure": "kPa", "force": "N"}.get(kind, "mm")
    problem = f"{unit}: no unit of a {kind}" if unit else "states no unit"
    raise InputError(problem, file=file, key=f"column {name}", remedy=f"write it into the name, as {kind} ({right})")


LEAST_POINTS = 8
"""Least number of points of a curve: two for each constant of a law with four, our choice."""

LEAST_STRETCH = 1.2
"""Stretch that a curve must reach: a shorter curve determines a modulus but no law."""

MODULI = (0.002, STIFFEST_ELASTOMER_MPA)
"""Range of shear moduli, MPa: outside it the numbers are in other units. The softest silicone gels have about 0.005,
printed elastomers up to about 25."""

_MOST_STRAIN = 20.0
"""Strains above this are per cent: the silicones tear at 10 at most."""

_BACK, _BROKEN, _AGREE = 2e-3, 0.9, 0.05
_MOST_FACTS = 60
_LONGEST_FACT = 500
_FACT = re.compile(r"([A-Z][^;,\t]*)[;,\t]([^;,\t]+)[;,\t]*")


@dataclass(frozen=True, slots=True)
class SpecimenSize:
    """Lengths of a specimen in mm; None for one that the file may state. ``opening`` is the diameter within which an
    inflated disc is free."""

    gauge_length: float | None = None
    width: float | None = None
    thickness: float | None = None
    opening: float | None = None


def read_tension(path: Path, size: SpecimenSize | None = None, kind: str | None = None) -> TensionCurve:
    """The loading curve of a file: text, a workbook or parquet, with a header that names quantity and unit.

    ``kind`` is that of the test, a key of `RATIOS`; None: as the names of the columns say, else tension.

    Raises InputError for a file that cannot be read, units that no elastomer has, a stretch that falls, a negative
    stress, too few points, and true and engineering columns that contradict one another."""
    layout, file = layout_of(path), str(path)
    pairs = column_pairs(layout.names, layout.units, file)
    facts = _facts(path)
    pair, length, load = _first_filled(path, pairs, layout)
    stretch, notes = _stretch(pair.length, length, file, _size(size, facts))
    kind = _kind(pair, kind, file)
    if pair.load.kind == "pressure":
        stress, note = _at_pole(path, layout, stretch, load * (pair.load.factor or 1.0), _size(size, facts))
        notes.append(note)
    else:
        stress = _stress(pair.load, load, stretch, file, _size(size, facts))
    if pair.load.true:
        notes.append("true strain and stress were turned into stretch and nominal stress, for an incompressible solid")
    elif pair.load.kind == "stress" and not pair.load.stated:
        notes.append(f"column {pair.load.name} is taken as nominal stress (force over the undeformed cross-section)")
    _agrees(path, pairs, layout, pair, stretch, stress)
    deep = float(stress[np.argmax(np.abs(stress))])
    if deep < 0.0:
        problem, key = f"the stress that is greatest in size is {deep:.4g} MPa", f"column {pair.load.name}"
        remedy = "tension is positive, stretch and stress alike: turn the signs in the file"
        raise InputError(problem, file=file, key=key, remedy=remedy)
    curve = _loading(TensionCurve(stretch, stress, file, tuple(notes), facts=facts, kind=kind))
    _plausible(curve)
    return curve


def _kind(pair: ColumnPair, given: str | None, file: str) -> str:
    """Kind of test as given or as the columns are named; tension without either. Raises InputError if they differ."""
    words = re.split(r"[\W_]+", f"{pair.length.name} {pair.load.name}".lower())
    named = "equibiaxial" if pair.load.kind == "pressure" else next((_KINDS[w] for w in words if w in _KINDS), None)
    if given is None and named is None and "shear" in words:
        remedy = "only planar tension (pure shear) is read: name it Planar or Pure Shear, or give `kinds` planar"
        raise InputError("a shear that is not named pure is taken for simple shear", file=file, remedy=remedy)
    if given is not None and named is not None and given != named:
        problem = f"{given}, but its columns {pair.length.name} and {pair.load.name} are of a test that is {named}"
        raise InputError(problem, file=file, key="kinds", remedy=f"give {named} for it, or other names to the columns")
    return given or named or "tension"


CAP = 1.10
"""Radius of curvature at the pole over that of a spherical cap of the same height, of a flat disc clamped and inflated:
membranes of neo-Hookean and Mooney-Rivlin solids (c01 up to 0.3 of the sum), integrated from pole to rim, have 1.09 to
1.11 at pole stretches of 1.05 to 1.4, and 1.05 to 1.12 up to 2. The height does not give the stretch of the pole:
Hill's 1 + (h/a)^2 (Phil. Mag. 41, 1133, 1950) makes the stress of the same membranes 14 to 37 % too small."""


def _at_pole(path: Path, layout: TableLayout, stretch: Array, pressure: Array, size: SpecimenSize) -> tuple[Array, str]:
    """Nominal stress (n,) at the pole of an inflated disc, p R l / (2 t0), as the true one is p R / (2 t) on a wall of
    t = t0 / l^2; and a note. Raises InputError without the thickness, or the radius or height of the pole."""
    known = [column for names in zip(layout.names, layout.units, strict=True) if (column := _column(*names, str(path)))]
    bent = next((one for kind in ("radius", "height") for one in known if one.kind == kind), None)
    if bent is None:
        remedy = "add Radius (mm), of curvature at the pole, or Height (mm)"
        raise InputError("a pressure makes no stress without the curvature of the pole", file=path, remedy=remedy)
    for key, value in (("thickness", size.thickness), ("opening", size.opening)):
        if value is None and (key == "thickness" or bent.kind == "height"):
            problem = f"a pressure makes no stress without the disc's {key}"
            raise InputError(problem, file=path, remedy=f"give `{key}_mm`")
    radius = whole(path, (bent.name,), layout)[1][0] * (bent.factor or 1.0)
    note = "an inflated disc: stress of its pole by pressure and radius of curvature"
    if bent.kind == "height":
        height = np.maximum(radius, 1e-9)
        radius = CAP * ((0.5 * (size.opening or 0.0)) ** 2 + height**2) / (2.0 * height)
        note += f", taken as {CAP:g} of a cap's of its height, which is within 5 % up to a stretch of 2"
    return pressure * radius * stretch / (2.0 * (size.thickness or 1.0)), note


def _first_filled(path: Path, pairs: list[ColumnPair], layout: TableLayout) -> tuple[ColumnPair, Array, Array]:
    """First pair whose columns hold numbers, and the numbers of its length and load. Raises the first pair's InputError
    if none does."""
    failures = []
    for pair in pairs:
        try:
            values = whole(path, (pair.length.name, pair.load.name), layout)[1]
            return pair, values[0], values[1]
        except InputError as error:
            failures.append(error)
    raise failures[0]


def _facts(path: Path) -> dict[str, str]:
    """Entries of the lines above the table that state one thing each, such as ``Speed (mm/min);450``."""
    if path.suffix.lower() in (".parquet", ".xlsx", ".xlsm", ".tdms"):
        return {}
    facts: dict[str, str] = {}
    for line in head_lines(path, None)[0][:_MOST_FACTS]:
        # The pattern takes the square of the length.
        if len(line) <= _LONGEST_FACT and (known := _FACT.fullmatch(line.strip())):
            facts.setdefault(known[1].strip(), known[2].strip())
    return {key: value for key, value in facts.items() if key != "PARAMETER"}


def _size(given: SpecimenSize | None, facts: dict[str, str]) -> SpecimenSize:
    given = given or SpecimenSize()

    def stated(word: str) -> float | None:
        for key, value in facts.items():
            if word in key.lower() and "mm" in key.lower():
                try:
                    return float(value)
                except ValueError:
                    return None
        return None

    return SpecimenSize(
        given.gauge_length or stated("length"),
        given.width or stated("width"),
        given.thickness or stated("thickness"),
        given.opening or stated("opening"),
    )


def _stretch(column: TensileColumn, values: Array, file: str, size: SpecimenSize) -> tuple[Array, list[str]]:
    key = f"column {column.name}"
    if column.kind == "travel":
        if size.gauge_length is None:
            problem = "an extension makes no stretch without the length that it is of"
            raise InputError(problem, file=file, key=key, remedy="give `gauge_length` in mm")
        notes = [f"extension over the gauge length of {size.gauge_length:g} mm"]
        return 1.0 + values * (column.factor or 1.0) / size.gauge_length, notes
    scaled = values * (1.0 if column.factor is None else column.factor)
    if column.kind == "stretch":
        if scaled.min() < 1.0 - 0.1:
            problem = f"a stretch begins at 1, and this at {scaled.min():.4g}"
            raise InputError(problem, file=file, key=key, remedy="is it a strain? Name the column so")
        return scaled, []
    if column.factor is None and scaled.max() > _MOST_STRAIN:
        problem = f"a strain of {scaled.max():.4g}, {100 * scaled.max():.4g} %: is it in per cent?"
        raise InputError(problem, file=file, key=key, remedy=f"name the column {column.name} (%)")
    if scaled.min() > 0.9:
        problem = f"a strain begins at 0, and this at {scaled.min():.4g}"
        raise InputError(problem, file=file, key=key, remedy="is it a stretch? Name the column so")
    return (np.exp(scaled), []) if column.true else (1.0 + scaled, [])


def _stress(column: TensileColumn, values: Array, stretch: Array, file: str, size: SpecimenSize) -> Array:
    scaled = values * (column.factor or 1.0)
    if column.kind == "stress":
        return scaled / stretch if column.true else scaled
    if size.width is None or size.thickness is None:
        problem = "a force makes no stress without the cross-section that it pulls"
        raise InputError(problem, file=file, key=f"column {column.name}", remedy="give `width` and `thickness` in mm")
    return scaled / (size.width * size.thickness)


def _agrees(
    path: Path, pairs: list[ColumnPair], layout: TableLayout, used: ColumnPair, stretch: Array, stress: Array
) -> None:
    """Raise InputError if engineering and true columns contradict one another, where a file has both."""
    for other in pairs:
        if other is used or other.load.kind != "stress" or other.length.kind == "travel":
            continue
        try:
            length, load = whole(path, (other.length.name, other.load.name), layout)[1]
        except InputError:
            continue
        again, _ = _stretch(other.length, length, str(path), SpecimenSize())
        second = _stress(other.load, load, again, str(path), SpecimenSize())
        k = int(np.argmax(stretch))
        off = abs(second[k] / stress[k] - 1.0) if stress[k] else np.inf
        if off > _AGREE or abs(again[k] / stretch[k] - 1.0) > _AGREE:
            raise InputError(
                f"{used.load.name} and {other.load.name} contradict one another: at a stretch of {stretch[k]:.3g} they "
                f"make {stress[k]:.4g} and {second[k]:.4g} MPa of nominal stress",
                file=path,
                remedy="engineering stress is force over the undeformed cross-section, true stress is that times the "
                "stretch: are the names exchanged?",
            )


def _loading(curve: TensionCurve) -> TensionCurve:
    """Points up to the greatest stress, each at a greater stretch. Raises InputError if the stretch falls."""
    stretch, stress, notes = curve.stretch, curve.stress, list(curve.notes)
    last = int(np.argmax(stress))
    if (stress[last:] < _BROKEN * stress[last]).any():
        notes.append(f"points after the greatest stress, at a stretch of {stretch[last]:.3g}, are left out")
        stretch, stress = stretch[: last + 1], stress[: last + 1]
    highest = np.maximum.accumulate(stretch)
    falls = np.flatnonzero(stretch < highest - _BACK * (highest[-1] - 1.0) - 1e-12)
    if falls.size:
        k = int(falls[0])
        raise InputError(
            f"the stretch falls from {highest[k]:.4g} to {stretch[k]:.4g} at point {k + 1}",
            file=curve.file,
            remedy="give the points of one loading: of a cyclic test its last loading, without the pre-load",
        )
    keep = np.concatenate([[True], stretch[1:] > highest[:-1]]) & (stretch > 1.0)
    return replace(curve, stretch=stretch[keep], stress=stress[keep], notes=tuple(notes))


def _plausible(curve: TensionCurve) -> None:
    """Raise InputError for too few points, a largest stretch that is too small, or a modulus outside `MODULI`."""
    if curve.stretch.size < LEAST_POINTS:
        raise InputError(f"{curve.stretch.size} points", file=curve.file, remedy=f"at least {LEAST_POINTS}")
    most = float(curve.stretch[-1])
    if float(curve.tension[-1]) < LEAST_STRETCH:
        problem = f"the largest stretch is {most:.4g}, a strain of {100 * (most - 1):.3g} %"
        remedy = f"a law needs at least {LEAST_STRETCH:g}; is the strain in per cent, or not a strain at all?"
        raise InputError(problem, file=curve.file, remedy=remedy)
    modulus = fit_law(LawForm("neo-hookean", 1), [curve]).constants[0]
    if not MODULI[0] <= modulus <= MODULI[1]:
        raise InputError(
            f"stress over stretch makes a shear modulus of {modulus:.4g} MPa; an elastomer has {MODULI[0]:g} to "
            f"{MODULI[1]:g} MPa{_other_unit(modulus)}",
            file=curve.file,
            remedy="write the unit of the stress into the column's name",
        )


def _other_unit(modulus: float) -> str:
    """Guess of the unit that the numbers are in, as text; "" without one."""
    if modulus > MODULI[1]:
        return ": are the numbers in kPa and named MPa?"
    return ": are the numbers in MPa and named kPa?" if modulus > 0.0 else ""
