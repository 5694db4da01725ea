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
    with bar("pressing the sensor"):
        record = told(design, changes(set_, calibration), asked)
    print_answer(record, discrimination_text, json=json)


def discrimination_text(record: DiscriminationRecord) -> str:
    """Tables of what is told, of the confusion of classes, and the planned pressures."""
    pressures = ", ".join(f"{one_kPa:g}" for one_kPa in record.driving_pressures_kPa)
    balls = record.least_radius_mm is not None
    head = ["object", "force N", "force +- %", "radius mm" if balls else "modulus MPa", "region", "force"]
    rows = []
    for one in record.told:
        low, high = one.curvature_interval_per_mm or one.compliance_interval_per_MPa or (0.0, 0.0)
        limit = _FLAT if balls else _STIFF
        objects = "plate" if high < limit else f"{_inverse(high, limit)} to {_inverse(low, limit)}"
        ratios = [f"{one.area_ratio:.2f}", f"{one.force_ratio:.2f}"]
        rows.append([one.object, f"{one.force_N:.3g}", f"{one.force_half_width_percent:.1f}", objects, *ratios])
    lines = [
        f"{record.design}: {_objects(record)}, one force at {pressures} kPa",
        f"noise of a rise {record.noise_kPa:.3g} kPa{_travel(record)}, error that readings do not share "
        f"{record.error_percent:g} %",
        "",
        table_text(head, rows),
        "",
        "95 % intervals by all readings. Region and force: the area of the 95 % region of force and object, and the",
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


_FLAT, _STIFF = 1e-3, 0.02
"""Curvature, 1/mm, and compliance, 1/MPa, below which an object is a rigid plate here: a metre and 50 MPa."""


def _inverse(value: float, limit: float) -> str:
    return "plate" if value < limit else f"{1.0 / value:.3g}"


def _objects(record: DiscriminationRecord) -> str:
    if record.least_radius_mm is not None:
        return f"plates and balls from {record.least_radius_mm:g} mm"
    return f"plates and blocks from {record.least_modulus_MPa:g} MPa"


def _travel(record: DiscriminationRecord) -> str:
    return "" if record.travel_noise_mm is None else f", of a travel {record.travel_noise_mm:g} mm"


def _confused(record: DiscriminationRecord) -> list[list[str]]:
    both = zip(record.classes, record.confusion, record.confusion_single, strict=True)
    return [[name, *(f"{100.0 * one:.0f}" for one in (*several, *single))] for name, several, single in both]
