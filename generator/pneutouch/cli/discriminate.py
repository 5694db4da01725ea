"""``pneutouch discriminate``: objects and forces by readings at several driving pressures."""

from typing import Any

from pneutouch.cli.app import CalibrationOption, DesignArgument, JsonOption, SetOption, app, changes, print_answer
from pneutouch.cli.declared import given, with_options
from pneutouch.cli.terminal import bar, table_text
from pneutouch.results.discrimination import DiscriminationRecord
from pneutouch.spec.options import DiscriminationOptions


@app.command()
@with_options(DiscriminationOptions)
def discriminate(
    design: DesignArgument,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    json: JsonOption = False,
    **options: Any,
) -> None:
    """State how well readings at several driving pressures tell an object and its force; plan the pressures."""
    from pneutouch.workflows.discriminate import discriminate as told

    asked = given(DiscriminationOptions, options)
    with bar("pressing the sensor by plates and balls"):
        record = told(design, changes(set_, calibration), asked)
    print_answer(record, discrimination_text, json=json)


_HEAD = ["object", "force N", "force +- %", "radius mm", "region", "force"]


def discrimination_text(record: DiscriminationRecord) -> str:
    """Tables of what is told, of the confusion of classes, and the planned pressures."""
    pressures = ", ".join(f"{one_kPa:g}" for one_kPa in record.driving_pressures_kPa)
    rows = []
    for one in record.told:
        low, high = one.curvature_interval_per_mm
        radii = "plate" if high < _FLAT else f"{_radius(high)} to {_radius(low)}"
        ratios = [f"{one.area_ratio:.2f}", f"{one.force_ratio:.2f}"]
        rows.append([one.object, f"{one.force_N:.3g}", f"{one.force_half_width_percent:.1f}", radii, *ratios])
    lines = [
        f"{record.design}: plates and balls from {record.least_radius_mm:g} mm, one force at {pressures} kPa",
        f"noise of a rise {record.noise_kPa:.3g} kPa, error that readings do not share {record.error_percent:g} %",
        "",
        table_text(_HEAD, rows),
        "",
        "95 % intervals by all readings. Region and force: the area of the 95 % region of force and curvature, and the",
        f"width of the interval of the force, over those by the best single pressure, {record.best_single_kPa:g} kPa.",
        f"In the mean the region is {100.0 * record.area_ratio:.0f} % of that.",
        "",
        "told as, percent: by all readings, and by the best single one",
        table_text(["", *record.classes, *record.classes], _confused(record)),
    ]
    if record.plan is not None:
        best = ", ".join(f"{one_kPa:g}" for one_kPa in record.plan.driving_pressures_kPa)
        lines += [
            "",
            f"planned: {best} kPa; the region is {100.0 * record.plan.area_ratio:.0f} % of the best single one's",
        ]
    return "\n".join(lines)


_FLAT = 1e-3
"""Curvature, 1/mm, below which a ball is as flat as a plate here: its radius is a metre."""


def _radius(curvature: float) -> str:
    return "plate" if curvature < _FLAT else f"{1.0 / curvature:.3g}"


def _confused(record: DiscriminationRecord) -> list[list[str]]:
    both = zip(record.classes, record.confusion, record.confusion_single, strict=True)
    return [[name, *(f"{100.0 * one:.0f}" for one in (*several, *single))] for name, several, single in both]
