"""Findings of the print rules on a pad, on its cell as a sensor, and on neighbours that meet when they are pressed."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.subject import accepted, glued_seat
from pneutouch.parts.pad.solids import channel_length
from pneutouch.printability import Finding, SensorContext, check
from pneutouch.printability.subject import PrintItem, PrintSubject
from pneutouch.results.printing import Excess
from pneutouch.wording import data_of
from pneutouch.workflows.pad.load import ResolvedPad

_HINTS: dict[str, dict[str, str]] = data_of(__file__)
"""Remedies in the files of pad and cell by body and rule."""

_ANGLES, _ROWS, _OF_PLACE = np.zeros(1), 4, ("cleaning", "freedom")


def pad_findings(pad: ResolvedPad) -> list[Finding]:
    """All findings, errors first. Raises InputError if the cell cannot work."""
    own, *others = [_context(pad, cell) for cell in pad.worst]
    reasons = pad.scene.design.accepted.reasons
    found = [*_channels_once(pad, check(subject_of(pad), own)), *_neighbours(pad)]
    known = {(one.rule, one.message) for one in found}
    for group, context in zip(pad.file.pad.groups, others, strict=True):
        cells, more = ", ".join(map(str, group.cells)), check(subject_of(pad), context)
        new = [one for one in more if one.rule not in _OF_PLACE and (one.rule, one.message) not in known]
        found += [replace(one, message=f"of cells {cells}: {one.message}") for one in new]
    return sorted((accepted(one, reasons) for one in found), key=lambda one: one.rank)


def _context(pad: ResolvedPad, cell: Evaluation) -> SensorContext:
    return SensorContext(
        cell.prediction,
        cell.sensor,
        cell.rating,
        gauge=cell.scene.gauge,
        curves=cell.curves,
        glued=glued_seat(pad.scene),
        scene=cell.scene,
    )


def subject_of(pad: ResolvedPad) -> PrintSubject:
    """Membrane and manifold as they stand in their machines, a job each."""
    items = []
    for body, solid in zip(pad.bodies, pad.solids, strict=True):
        up = (0.0, 0.0, 1.0 if pad.stands_up(body.name) else -1.0)
        items.append(PrintItem(body, *pad.machine(body.name), solid, up=up, job=body.name, hints=_HINTS[body.name]))
    return PrintSubject(tuple(items), (), pad.name)


_NEAR = 1.0
"""Distance in mm from the wall of a channel within which a finding is on it: the rules measure hollows by voxels."""


def _channels_once(pad: ResolvedPad, found: list[Finding]) -> Iterator[Finding]:
    """The findings with those on cleaning the channels as one: channels are alike, straight and open at both ends, so
    that no narrower opening is in them."""
    layout, inside = pad.layout, []
    for one in found:
        if one.rule == "cleaning" and one.body == "manifold" and one.where_mm is not None:
            x, y, z = one.where_mm
            share = 1.0 + (layout.fan - 1.0) * (layout.middle - z) / (layout.middle - layout.meeting)
            away = min(math.dist((x, y), axis) for axis in layout.spread(share))
            if layout.low - layout.cell.port.length <= z and away <= layout.channel + _NEAR:
                inside.append(one)
                continue
        yield one
    length = max(channel_length(layout, k) for k in range(len(layout.places)))
    if inside:
        wide = 2.0 * layout.channel
        message = f"{len(layout.places)} channels {wide:.2f} mm wide are up to {length / wide:.0f} times as long"
        fix, source = "push a wire through and flush from both sides: every channel is straight", inside[0].source
        yield Finding("cleaning", "warning", "manifold", message, fix, source, None, None)


def widest(pad: ResolvedPad) -> tuple[float, ...]:
    """By group: greatest radius in mm of a pressed dome, at the end of its range, over its driving pressures."""
    return tuple(_widest(cell) for cell in pad.worst)


def _widest(cell: Evaluation) -> float:
    radii = [cell.assembly.layout.outer_radius]
    for state in cell.prediction.states:
        if state.face is not None:
            face = state.face()
            rows = np.arange(0.0, face.edges + 0.5 / _ROWS, 1.0 / _ROWS)
            radii.append(float(face.positions(rows, _ANGLES)[:, 0, 0].max()))
    return max(radii)


def _neighbours(pad: ResolvedPad) -> Iterator[Finding]:
    """An error if neighbours that are pressed together meet: the prediction of a cell knows no neighbour."""
    places, by_group = pad.layout.places, widest(pad)
    radii = [by_group[group] for group in pad.file.pad.group_of]
    pairs = [
        (math.dist(places[a], places[b]), radii[a] + radii[b], a, b) for a, b in combinations(range(len(places)), 2)
    ]
    pitch, needs, one, other = min(pairs, key=lambda pair: pair[0] / pair[1])
    if pitch >= needs:
        return
    least = math.ceil(10.0 * needs / pitch * min(pairs)[0]) / 10.0
    message = (
        f"pressed to the end of their range, cells {one + 1} and {other + 1} bulge to {needs:.2f} mm and meet: "
        f"they stand {pitch:.2f} mm apart"
    )
    fix = f"raise pad.pitch_mm to {least:g}, or lower indentation.depth_mm or the driving pressures of the cell"
    middle = 0.5 * (np.array(places[one]) + np.array(places[other]))
    where = (float(middle[0]), float(middle[1]), 0.0)
    excess = Excess(pitch, needs, "mm")
    source = "own: the solid's wall under a flat plate"
    yield Finding("neighbours", "error", "membrane", message, fix, source, where, excess)
