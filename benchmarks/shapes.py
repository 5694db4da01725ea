"""What each shape of dome does at one footprint: ``python -m benchmarks.shapes`` (twelve minutes).

Writes docs/background/shapes.json: TangoPlus at 9.25 mm inner radius, each shape as ``new --shape`` starts it, at three
walls, by the model solid under a plate, and under a ball central and off the axis. Also the best of each shape for
three targets.
"""

from __future__ import annotations

from typing import Any

from benchmarks.store import LIBRARY, store, timed
from pneutouch.cli.select import SELECT_FIELDS
from pneutouch.errors import PneutouchError
from pneutouch.evaluation import evaluate
from pneutouch.results.record import plain
from pneutouch.shape import SHAPES, starting_sizes
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.select.shapes import select_shapes

RADIUS, WALLS = 9.25, (1.0, 1.5, 2.0)
PRESSURES = (5.0, 15.0)
BALL, OFFSET = 5.0, 2.0
TARGETS = (
    ("Thin and flat, under 6 mm high", "--shape any --sensitivity 2.5 --at 12 --max-height 6 --prefer low"),
    ("The most travel, at most 25 mm wide", "--shape any --sensitivity 2 --at 0 --max-diameter 25 --prefer travel"),
    ("Least moved by a small ball", "--shape any --sensitivity 2 --at 12 --max-diameter 25 --prefer ball"),
)
FIXED = {"pneumatics.driving_pressures_kPa": list(PRESSURES), "indentation.depth_mm": None}


def main() -> None:
    """Measure every shape and store the figures."""
    rows = [shape_row(key, wall) for key in SHAPES for wall in WALLS]
    found = {"rows": rows, "targets": [target_row(*each) for each in TARGETS]}
    store("shapes", {"radius_mm": RADIUS, "ball_mm": BALL, "offset_mm": OFFSET, **found})


def target_row(title: str, flags: str) -> dict[str, Any]:
    """The best design of each shape for a target in the options of ``select``."""
    words = dict(zip(*[iter(flags.split())] * 2, strict=True))
    tables = {
        table: {key: value for flag, (place, key, value) in parsed(words).items() if place == table}
        for table in ("target", "setting", "weights")
    }
    found, seconds = timed(lambda: select_shapes(validate(Target, tables, title), title, LIBRARY))
    designs = [plain(one) for one in found.record.designs]
    return {"title": title, "flags": flags, "cpu_s": seconds, "designs": designs, "missed": list(found.missed)}


def parsed(words: dict[str, str]) -> dict[str, tuple[str, str, Any]]:
    """Table, key and value of each option."""
    fields = {f"--{name.replace('_', '-')}": option for name, option in SELECT_FIELDS.items()}
    return {
        flag: (
            fields[flag].table,
            fields[flag].key,
            [text] if flag == "--shape" else text if flag == "--prefer" else float(text),
        )
        for flag, text in words.items()
    }


def changes_of(key: str, wall: float) -> dict[str, Any]:
    """A shape as a new design starts with it, at one wall."""
    sizes = {f"membrane.{name}": size for name, size in starting_sizes(key, RADIUS).items()}
    return {"membrane.shape": key, "membrane.wall_thickness_mm": wall, **sizes, **FIXED}


def shape_row(key: str, wall: float) -> dict[str, Any]:
    """Figures of one shape at one wall: height, travel, and for each driving pressure the press; or why there is none."""
    row: dict[str, Any] = {"shape": key, "wall_mm": wall}
    try:
        found, seconds = timed(lambda: evaluate("paper-dome", changes_of(key, wall), library=LIBRARY))
    except PneutouchError as error:
        return {**row, "refused": str(error).partition(": ")[2]}
    layout, limit = found.assembly.layout, found.prediction.limit_point
    states = [state_row(state) for state in found.prediction.states]
    row |= {"cpu_s": seconds, "height_mm": layout.shape.outer_height, "over_mount_mm": height_over(found)}
    row |= {"limit_kPa": None if limit is None else limit.driving_pressure / KPA, "states": states}
    if wall == WALLS[1]:
        row |= {"ball": off_plate(key, wall, 0.0, states), "ball_aside": off_plate(key, wall, OFFSET, states)}
    return row


def height_over(found: Any) -> float:
    """Height of the inflated dome over the mounting plate at the first driving pressure, mm."""
    return float(found.prediction.states[0].apex_outer - found.assembly.layout.plate_high)


def state_row(state: Any) -> dict[str, Any]:
    """Figures of one state; None without a line."""
    figures, row = state.figures, {"driving_pressure_kPa": state.driving_pressure / KPA, "range_mm": state.range_end}
    ending = next((event.kind for event in state.events if event.ends_range), None)
    row |= {"ends": ending, "apex_mm": state.apex_outer}
    if figures is None:
        return row
    return row | {
        "sensitivity_kPa_per_N": figures.sensitivity,
        "stiffness_N_per_mm": figures.stiffness,
        "force_N": figures.force_range[1],
        "r_squared": figures.r_squared,
    }


def off_plate(key: str, wall: float, offset: float, plate: list[dict[str, Any]]) -> list[float | None] | str:
    """Sensitivity under a ball over that under the plate, for each driving pressure, less 1; or why there is none."""
    ball = {"contact.object": "ball", "contact.ball_radius_mm": BALL, "contact.offset_mm": offset}
    model = "harmonic" if offset else "solid"
    try:
        found = evaluate("paper-dome", {**changes_of(key, wall), **ball}, model=model, library=LIBRARY)
    except PneutouchError as error:
        return str(error).rpartition(": ")[2]
    pairs = zip(found.prediction.states, plate, strict=True)
    known = [(state.figures, row.get("sensitivity_kPa_per_N")) for state, row in pairs]
    return [None if one is None or of_plate is None else one.sensitivity / of_plate - 1.0 for one, of_plate in known]


if __name__ == "__main__":
    main()
