"""Pads on the page: what their cells and their reading say to an object, and the table of a cell as a job."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.api.pad import PadTouch
from pneutouch.body.shapes import polygon
from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.touch.cell import RADII, TILTS, CellTable
from pneutouch.results.record import plain
from pneutouch.spec.read import toml_value
from pneutouch.spec.values import is_finite
from pneutouch.studio.form import FormField, FormGroup, Question
from pneutouch.studio.job import Report
from pneutouch.workflows.pad.load import ResolvedPad, load_pad
from pneutouch.workflows.pad.touch import pad_model

_KEPT = 4
"""Number of pads at a driving pressure that are kept ready: each holds the tables of its readers."""


_OBJECTS = {
    "ball": ("x_mm", "y_mm", "radius_mm", "depth_mm"),
    "cylinder": ("x_mm", "y_mm", "turn_deg", "radius_mm", "depth_mm"),
    "plate": ("slope_x", "slope_y", "depth_mm"),
}
"""Fields of the objects, as the methods of `PadTouch` take them."""


class _NoTableError(Exception):
    pass


class Pads:
    """The pads that a library knows; one that was opened stays as its files were then."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._pads, self._touches = dict[str, ResolvedPad](), dict[tuple[str, str], PadTouch]()

    def open(self, question: Question) -> Mapping[str, Any]:
        """The pad named by ``base`` as its files are now, from the side of its domes, mm, and the form of what touches
        it. Raises InputError."""
        name, known = question.base, self._library.paths("pads")
        if name not in known:
            raise InputError(f"{name[:40]!r}: no such pad", remedy=f"choose one of {', '.join(known)}")
        self._pads[name] = pad = load_pad(name, library=self._library)
        self._touches.clear()
        corners = np.round(polygon(pad.layout.membrane_outline, 0.02), 3)
        places, radii = pad.layout.places, [dome.outer_radius for dome in pad.layout.domes]
        groups = [FormGroup("touch", _fields(pad))]
        return {"outline_mm": corners, "places_mm": places, "dome_radii_mm": radii, "groups": groups}

    def given(self, question: Question) -> tuple[ResolvedPad, Mapping[str, Any]]:
        """The pad of a question, and by key what its form says. Raises InputError at the field."""
        if question.base not in self._pads:
            self.open(question)
        fields = _fields(pad := self._pads[question.base])
        for name in question.values.keys() - {field.name for field in fields}:
            raise InputError("no field of a touch", key=name)
        return pad, {field.name.partition(".")[2]: _value(field, question.values) for field in fields}

    def touch(self, question: Question) -> Mapping[str, Any]:
        """The fields of `PadContact` and `PadEstimate` for the object that touches a pad, None for what is not known;
        empty while there is no table of its cell. Raises InputError at the field, and as `pad_model` does."""
        pad, given = self.given(question)
        key = pad.name, given["pressure"]
        if key not in self._touches:
            try:
                touch = PadTouch(pad_model(pad, float(key[1]), _missing))
            except _NoTableError:
                return {}
            if len(self._touches) >= _KEPT:
                self._touches.clear()
            self._touches[key] = touch
        touch = self._touches[key]
        contact = getattr(touch, given["object"])(**{name: given[name] for name in _OBJECTS[given["object"]]})
        answer = {"contact": contact, "read": touch.read(contact.pressure_rises_kPa, given["noise_kPa"])}
        # JSON has no NaN.
        return dict(json.loads(json.dumps(plain(answer)), parse_constant=lambda _: None))


def tabulate(arguments: Mapping[str, Any], folder: Path, report: Report) -> Mapping[str, str]:
    """Tabulate the cell of a pad at the driving pressure of ``question``, and keep the table. Raises InputError."""
    pad, given = Pads(Library.default()).given(Question.of(arguments.get("question")))
    pad_model(pad, float(given["pressure"]))
    return {"name": pad.name}


def _missing(sensor: Sensor, pressure: float) -> CellTable:
    """Stand in for what makes a table, which takes too long here."""
    raise _NoTableError


def _fields(pad: ResolvedPad) -> list[FormField]:
    """The form of what touches a pad; places and slopes have equal ranges along x and y, so that a map is square."""
    corners, depth = np.array(polygon(pad.layout.membrane_outline, 0.02)), pad.scene.design.depth_mm
    low, high = corners.min(axis=0), corners.max(axis=0)
    half, (x, y) = math.ceil(0.5 * (high - low).max() + 1.0), np.round(0.5 * (low + high)).tolist()
    # Rounded inwards.
    radii, heights = zip(*((dome.inner_radius, dome.shape.outer_height) for dome in pad.layout.domes), strict=True)
    steep = math.floor(1e3 * math.tan(math.asin(TILTS[-1]))) / 1e3
    least, most = math.ceil(1e3 * RADII[0] * max(radii)) / 1e3, math.floor(1e3 * RADII[-1] * min(radii)) / 1e3
    pressures_kPa = pad.scene.design.pneumatics.driving_pressures_kPa
    first, deep = next((one_kPa for one_kPa in pressures_kPa if one_kPa > 0.0), pressures_kPa[0]), round(0.6 * depth, 1)
    pressures = [f"{one_kPa:g}" for one_kPa in pressures_kPa]
    rows: list[tuple[Any, ...]] = [
        ("pressure", "Driving pressure", "kPa", None, None, f"{first:g}", "Those of the cell's design.", pressures),
        ("object", "Object", "", None, None, "ball", "What touches the pad.", list(_OBJECTS)),
        (
            "depth_mm",
            "Depth",
            "mm",
            0.0,
            1.5 * depth + max(heights) - min(heights),
            deep,
            "Below the tops of the inflated domes.",
            [],
        ),
        ("radius_mm", "Radius", "mm", least, most, round(2.0 * least, 1), "A larger one is a plate.", []),
        ("x_mm", "At x", "mm", x - half, x + half, round(x + 0.2 * half, 1), "Place of its axis.", []),
        ("y_mm", "At y", "mm", y - half, y + half, round(y + 0.15 * half, 1), "Place of its axis.", []),
        ("turn_deg", "Turn", "°", 0.0, 180.0, 60.0, "Angle of the cylinder's axis to x.", []),
        ("slope_x", "Slope along x", "", -steep, steep, 0.05, "Rise of the plate by the way along x.", []),
        ("slope_y", "Slope along y", "", -steep, steep, 0.02, "Rise of the plate by the way along y.", []),
        ("noise_kPa", "Noise of a gauge", "kPa", 1e-4, 0.5, 0.002, "Standard deviation that intervals count.", []),
    ]
    choices = [[{"name": name, "title": ""} for name in row[-1]] for row in rows]
    kinds = ["choice" if names else "number" for names in choices]
    return [
        FormField(f"touch.{key}", label, unit, low, high, start, words, kind, False, names)
        for (key, label, unit, low, high, start, words, _), kind, names in zip(rows, kinds, choices, strict=True)
    ]


def _value(field: FormField, values: Mapping[str, str | None]) -> Any:
    """The value of a field of the form, its start where nothing is given. Raises InputError at the field."""
    text, names = values.get(field.name), [one["name"] for one in field.options]
    value: Any = field.default if text is None else toml_value(text)
    if field.low is None or field.high is None:
        if str(value) not in names:
            raise InputError(f"must be one of {', '.join(names)}", key=field.name, value=value)
        return str(value)
    if not is_finite(value) or not field.low <= value <= field.high:
        words = f"must be a number from {field.low:g} to {field.high:g} {field.unit}".rstrip()
        raise InputError(words, key=field.name, value=value)
    return float(value)
