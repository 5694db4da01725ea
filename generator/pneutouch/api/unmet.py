"""Reasons why a selection found no design, in short lines made from its document."""

from __future__ import annotations

from typing import Any

from pneutouch.api import show


def unmet_lines(document: dict[str, Any]) -> list[str]:
    """The nearest design and its misses, the requirements whose removal admits one, and the designs that a check
    rejects."""
    if "processes" in document:
        by_process = document["processes"].items()
        return [
            *(f"{process}: {line}" for process, one in by_process if not one["met"] for line in unmet_lines(one)),
            *(f"{process}: {why}" for process, why in document["left_out"].items()),
        ]
    if "nearest_constant_mix" in document:
        return _of_grade(document)
    lines = [f"rejected: {_size(each['design'])}: {each['reason']}" for each in document["rejected"]]
    nearest = document["nearest"]
    if nearest is not None:
        missed = [
            f"{name}{', not known' if percent is None else f' by {percent:.3g} %'}"
            for name, percent in nearest["misses_percent"].items()
        ]
        lines.append(f"nearest: {_size(nearest)}: misses {', '.join(missed) or 'nothing once rounded'}")
    if not document["rejected"]:
        dropped = document["dropped_requirements"]
        lines += [f"drop the requirement on {each['requirement']}: {each['attainable']}" for each in dropped]
        lines += [] if dropped else ["no design fits with any single requirement dropped"]
    return lines


def _of_grade(document: dict[str, Any]) -> list[str]:
    """The nearest grade: each share of a tolerance or limit that is used by more than the whole."""
    if document["rejected"]:
        return [f"rejected: {document['rejected']}"]
    best = document["design"]
    used = ", ".join(f"{name} by {100 * (share - 1):.3g} %" for name, share in best["share_used"].items() if share > 1)
    return [f"nearest grade: {best['reason'] or f'beyond what is allowed: {used}'}"]


def _size(design: dict[str, Any]) -> str:
    radius_mm, wall_mm = show.short(design["inner_radius_mm"]), show.short(design["wall_thickness_mm"])
    return f"{design['material']}, R0 {radius_mm} mm, t0 {wall_mm} mm"
