"""Errors of a design's force reading under contact off the centre, from the shipped table."""

from collections.abc import Callable, Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import ContactChart, ContactRow, ErrorCurves
from pneutouch.mechanics import Sensor, SensorPrediction, SensorState
from pneutouch.mechanics.anywhere.reading import (
    FARTHEST,
    SMALLEST_BALL,
    STEEPEST_TILT,
    TABLE_ERROR,
    ball_places,
    edge_places,
    force_logs,
    outside,
    place_uncertainty,
    plate_places,
    state_conditions,
)
from pneutouch.mechanics.anywhere.table import ContactPlaces, DomeConditions
from pneutouch.results.behaviour import ContactAnywhere, ContactErrors, ContactPlace
from pneutouch.spec.contact import ContactKind
from pneutouch.units import KPA
from pneutouch.wording import finite, rounded

_READINGS = (1.0 / 3.0, 2.0 / 3.0)
"""Shares of the range's travel whose readings are tabulated; the first is drawn."""

_BALLS = ((0.3, 0.0), (0.6, 0.0), (1.0, 0.0), (2.0, 0.0), (0.6, 0.3), (0.6, 0.6), (1.0, 0.6))
"""Radius and offset, in R0, of each ball in the table."""

_EDGES = ((0.3, 0.0), (1.0, 0.0), (0.3, 0.3), (1.0, 0.6))
"""Radius and offset, in R0, of each edge of a bar in the table."""

_TILTS_DEG = (10.0, 20.0)
_DRAWN_BALL, _FLATTEST, _POINTS = 0.6, 10.0, 41
_DIGITS = 4


def contact_chart(prediction: SensorPrediction, sensor: Sensor) -> ContactChart | str:
    """Errors of the force read at the lowest driving pressure from ambient on and the highest; or why unknown."""
    blown = [state for state in prediction.states if state.driving_pressure >= 0.0]
    states = blown[:1] + blown[1:][-1:]
    why = place_unknown(prediction, sensor, states) if blown else "its table has no states below ambient pressure"
    if why is not None:
        return why
    assert prediction.limits.limit_point is not None
    domes = state_conditions(sensor, states, prediction.limits.limit_point)
    size = sensor.dome.inner_radius
    ends = np.array([state.range_end for state in states]) / size
    levels = ends[:, None] * np.array(_READINGS)
    radius = size * np.geomspace(SMALLEST_BALL, _FLATTEST, _POINTS)
    offset, tilt = size * np.linspace(0.0, FARTHEST, _POINTS), np.linspace(0.0, STEEPEST_TILT, _POINTS)
    ball = np.full(_POINTS, size * _DRAWN_BALL)
    walls, still = domes.wall_ratio, np.zeros(_POINTS)
    widest = max(float(np.interp(state.range_end, state.indentation, state.contact_radius)) for state in states)

    def drawn(places: ContactPlaces) -> tuple[Array, ...]:
        return tuple(_percent(domes, places, levels[:, :1])[:, :, 0])

    return ContactChart(
        driving_pressures_kPa=tuple(state.driving_pressure / KPA for state in states),
        rises_kPa=_at_travels(states, size * levels, lambda state: state.pressure_rise / KPA),
        forces=_at_travels(states, size * levels, lambda state: state.force),
        by_radius=ErrorCurves(radius, drawn(ball_places(walls, radius / size, still))),
        by_offset=ErrorCurves(offset, drawn(ball_places(walls, ball / size, offset / size))),
        by_tilt=ErrorCurves(np.degrees(tilt), drawn(plate_places(walls, tilt))),
        edges_by_radius=ErrorCurves(radius, drawn(edge_places(walls, radius / size, still))),
        edges_by_offset=ErrorCurves(offset, drawn(edge_places(walls, ball / size, offset / size))),
        ball_radius=size * _DRAWN_BALL,
        rows=_rows(domes, levels, size),
        standard_uncertainties=tuple(place_uncertainty(domes, ends).tolist()),
        free_offset=max(sensor.protocol.plate_radius - widest, 0.0),
    )


def place_unknown(prediction: SensorPrediction, sensor: Sensor, states: Sequence[SensorState]) -> str | None:
    """Reason why the shipped table does not cover a sensor in its states; None if it does."""
    point = prediction.limits.limit_point
    if point is None:
        return "the dome has no limit point, over which the table is set"
    why = outside(sensor, state_conditions(sensor, states, point))
    return None if why is None else f"the table of contact anywhere does not cover the sensor: {why}"


def contact_anywhere(prediction: SensorPrediction, sensor: Sensor) -> ContactAnywhere:
    """Errors of the force read where object and place of contact are unknown, percent, None where a reading is not
    reached; or ``unknown`` alone, the reason why there are none."""
    chart = contact_chart(prediction, sensor)
    if isinstance(chart, str):
        return ContactAnywhere(unknown=chart)
    states = tuple(
        ContactErrors(
            driving_pressure_kPa=pressure_kPa,
            pressure_rise_kPa=chart.rises_kPa[k],
            contact_force_N=chart.forces[k],
            force_error_percent=tuple(row.errors_percent[k] for row in chart.rows),
            standard_uncertainty_relative=chart.standard_uncertainties[k],
        )
        for k, pressure_kPa in enumerate(chart.driving_pressures_kPa)
    )
    record = ContactAnywhere(
        contacts=tuple(ContactPlace(row.kind, row.radius, row.offset, row.tilt_deg) for row in chart.rows),
        states=states,
        plate_offset_without_effect_mm=chart.free_offset,
        table_error_relative=TABLE_ERROR,
    )
    return rounded(record, _DIGITS)


def _percent(domes: DomeConditions, places: ContactPlaces, levels: Array) -> Array:
    """Error of the force read over the true one, percent, (n, m, k): for n domes, m places and k readings."""
    return np.asarray(100.0 * np.expm1(-force_logs(domes, places, levels)))


def _rows(domes: DomeConditions, levels: Array, size: float) -> tuple[ContactRow, ...]:
    rows = [*_round_rows("ball", _BALLS, domes, levels, size), *_round_rows("edge", _EDGES, domes, levels, size)]
    plates = _percent(domes, plate_places(domes.wall_ratio, np.radians(_TILTS_DEG)), levels)
    tilted = [ContactRow("plate", None, 0.0, tilt, _numbers(plates[:, i])) for i, tilt in enumerate(_TILTS_DEG)]
    return (*rows, *tilted)


def _round_rows(
    kind: ContactKind, sizes: Sequence[tuple[float, float]], domes: DomeConditions, levels: Array, size: float
) -> list[ContactRow]:
    """Table rows of balls or edges with these pairs of radius and offset, in R0; ``size`` is R0 in mm."""
    radii, offsets = np.array(sizes).T
    places = (edge_places if kind == "edge" else ball_places)(domes.wall_ratio, radii, offsets)
    errors = _percent(domes, places, levels)
    return [
        ContactRow(kind, size * radius, size * offset, 0.0, _numbers(errors[:, i]))
        for i, (radius, offset) in enumerate(sizes)
    ]


def _numbers(errors: Array) -> tuple[tuple[float | None, ...], ...]:
    return tuple(tuple(finite(e) for e in row) for row in errors)


def _at_travels(
    states: Sequence[SensorState], travels: Array, curve: Callable[[SensorState], Array]
) -> tuple[tuple[float, ...], ...]:
    """Values of each state's curve at its travels (n, k), mm."""
    rows = [np.interp(row, state.indentation, curve(state)) for state, row in zip(states, travels, strict=True)]
    return tuple(tuple(row.tolist()) for row in rows)
