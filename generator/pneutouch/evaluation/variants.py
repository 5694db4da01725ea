"""The same sensor in every resin: the curves that show the effect of the offline parameter."""

from collections.abc import Sequence

import numpy as np

from pneutouch.errors import ComputationError
from pneutouch.evaluation.chart_data import ResinCurve
from pneutouch.mechanics import Sensor, SensorState, predict
from pneutouch.mechanics.contact_correction import plate_alone
from pneutouch.mechanics.limits import limit_point
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.spec.material import Material
from pneutouch.units import KPA

_POINTS = {"membrane": 12, "atlas": 25, "solid": 4}
"""Driving pressures a curve is computed at: the solid costs a tenth of a second each."""

_MARGIN = 0.95
"""Curves stop at this share of a resin's own limit."""

_AT_DEPTH = 1e-3
"""A range ends at the depth where the logarithm of its end is nearer to it than this."""

_LIMIT_SHARE = {"membrane": 1.0, "solid": 0.8}
"""A safe share of the membrane's limit pressure: thick compressible walls reach theirs earlier."""


def in_resin(sensor: Sensor, material: Material) -> Sensor:
    """The same sensor in another resin, with that resin's law and break strain, and without the first resin's
    correction."""
    return sensor.replace(wall=material_sensor(material).wall, correction=ResponseCorrection())


def resin_curves(
    sensor: Sensor,
    materials: dict[str, Material],
    highest: float,
    model: str,
    closure: str | None,
    states: Sequence[SensorState] = (),
) -> dict[str, ResinCurve]:
    """Sensitivity over driving pressure, from 0 to ``highest`` (MPa), by resin title.

    Each curve stops short of its own resin's limit point. A sheet of the membrane's is drawn by the membrane, any other
    by the atlas where the sensor is inside it, by the solid where not. Under friction or another object a few of the
    solid's suffice with the atlas; ``states`` of the sensor are what has been solved already. There is none for contact
    off the axis.
    """
    if sensor.protocol.off_axis is not None:
        return {}
    variants = {m.title: in_resin(sensor, m) for m in materials.values() if m.kind == "elastomer"}
    looked_up = {} if model == "membrane" else _by_atlas({t: plate_alone(v) for t, v in variants.items()}, highest)
    model = "membrane" if model == "membrane" else "solid"
    curves = {}
    for title, variant in variants.items():
        curve = looked_up.get(title)
        if curve is not None and variant.protocol.other_contact is not None:
            curve = _under_contact(variant, curve, states if variant == sensor else ())
        curve = curve or _by_model(variant, highest, model, closure)
        if curve is not None:
            curves[title] = curve
    return curves


def _by_atlas(variants: dict[str, Sensor], highest: float) -> dict[str, ResinCurve]:
    """Curves of the resins that the atlas covers, all in one call; without points outside it."""
    from pneutouch.mechanics.atlas.batches import batch_of
    from pneutouch.mechanics.atlas.respond import EDGE, OUTSIDE, respond
    from pneutouch.mechanics.atlas.table import shipped
    from pneutouch.mechanics.atlas_states import outside_atlas
    from pneutouch.mechanics.uncertainty.neighbours import joined

    inside = {title: variant for title, variant in variants.items() if outside_atlas(variant) is None}
    if not inside:
        return {}
    walls = np.array([variant.dome.wall_thickness / variant.dome.inner_radius for variant in inside.values()])
    limits = shipped().slices(walls, ()).limit_pressure * np.array([v.wall.shear_modulus for v in inside.values()])
    share = np.linspace(0.0, 1.0, _POINTS["atlas"])
    grids = [min(highest, _MARGIN * float(limit)) * share for limit in limits]
    steps = next(iter(inside.values())).protocol.steps
    response = respond(joined([batch_of(v, grid) for v, grid in zip(inside.values(), grids, strict=True)]), steps)
    known = np.isfinite(response.lines.sensitivity_kPa_per_N) & ~np.isin(response.ends, (OUTSIDE, EDGE))
    rows = zip(
        inside,
        grids,
        response.lines.sensitivity_kPa_per_N.reshape(-1, share.size),
        known.reshape(-1, share.size),
        strict=True,
    )
    return {
        title: ResinCurve(grid[kept] / KPA, values[kept], "atlas")
        for title, grid, values, kept in rows
        if kept.sum() > 1
    }


def _under_contact(variant: Sensor, plate: ResinCurve, states: Sequence[SensorState]) -> ResinCurve | None:
    """A resin's curve under its own contact, from few of the solid's; None if it cannot be solved at both ends.

    Where the ranges at both ends go to the depth, the atlas's curve ``plate`` times the ratio of the solid to it, whose
    logarithm is straight in between, or between the ``states`` where there are any. Where an event ends a range, the
    plate's range ends elsewhere: there a parabola through the logarithms of the solid's at both ends and the middle.
    """
    from pneutouch.mechanics.uncertainty import FIGURES, ContactModel
    from pneutouch.mechanics.uncertainty.contact_presses import pressed_logs

    at = plate.driving_pressure_kPa * KPA
    s, end = FIGURES.index("sensitivity_kPa_per_N"), FIGURES.index("range_end_mm")
    lowest, highest = float(at[0]), float(at[-1])
    ends = ContactModel(variant, (lowest, highest), states).logs
    if states or np.abs(ends[end] - np.log(variant.protocol.depth)).max() < _AT_DEPTH:
        ratio = ContactModel(variant, tuple(at.tolist()), states, least=2).ratio[s]
        kept = np.isfinite(ratio)
        values, model = np.exp(ratio[kept]) * plate.sensitivity_kPa_per_N[kept], "atlas corrected by the solid"
        return ResinCurve(at[kept] / KPA, values, model) if kept.sum() > 1 else None
    middle = 0.5 * (lowest + highest)
    three = np.append(ends[s], pressed_logs(variant.replace(waves=0), (middle,))[s])
    if not np.isfinite(three).all():
        return None
    parabola = np.polyfit([lowest, highest, middle], three, 2)
    return ResinCurve(at / KPA, np.exp(np.polyval(parabola, at)), "solid")


def _by_model(variant: Sensor, highest: float, model: str, closure: str | None) -> ResinCurve | None:
    """One resin's curve by a model of its own; None if this geometry cannot be solved in it, which must not stop the
    sheet."""
    top = min(highest, _MARGIN * _LIMIT_SHARE[model] * limit_point(variant).driving_pressure)
    pressures = np.linspace(0.0, top, _POINTS[model])
    try:
        states = predict("", variant, pressures.tolist(), model=model, closure=closure or "variational").states
    except ComputationError:
        return None
    values = [(p / KPA, s.figures.sensitivity_kPa_per_N) for p, s in zip(pressures, states, strict=True) if s.figures]
    if not values:
        return None
    x, y = zip(*values, strict=True)
    return ResinCurve(np.array(x), np.array(y), model)
