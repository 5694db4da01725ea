"""The measured datasheet as a page and as a PDF: its sections in order, with verdict, figures and conditions."""

import math
from collections import Counter
from dataclasses import replace
from statistics import median

from pneutouch import __version__
from pneutouch.bench.statistics import Estimate
from pneutouch.report.blocks import (
    Cell,
    Columns,
    FramedBlocks,
    Plot,
    Plots,
    Row,
    Sheet,
    SheetBlock,
    SheetTable,
    Text,
    Tile,
    Tiles,
    section,
)
from pneutouch.report.measured import plots, tables
from pneutouch.report.measured.tables import MOST_RUNS, CampaignReport, GroupComparison, ResinGroups, groups_of
from pneutouch.report.numbers import between, difference, number, overlap, signed, word_of
from pneutouch.report.pages import set_sheet
from pneutouch.results.measured import Verdict
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.units import KPA
from pneutouch.wording import SIMULATED, counted, enumerated

_KINDS = ("steps", "saturation", "loop", "relaxation")
_WHERE = "Formulas, units and sources: docs/howto/measuring.md, section Definitions."


def measured_datasheet(measured: CampaignReport) -> dict[str, bytes]:
    """``measured-datasheet.html`` and ``measured-datasheet.pdf``; the same bytes for the same campaign."""
    return set_sheet(described(measured), "measured-datasheet")


def described(measured: CampaignReport) -> Sheet:
    """The sheet with its plots drawn."""
    campaign, groups = measured.campaign, groups_of(measured.comparisons)
    resins, sensors = {run.resin for run in campaign.runs}, {run.sensor for run in campaign.runs}
    counts = (sensors, "specimen"), (campaign.runs, "run"), (resins, "resin")
    tool, mark = f"pneutouch {__version__}", SIMULATED if campaign.simulated else ""
    facts = (
        ("Design", f"{measured.scene.name}, {measured.scene.design.document.title}"),
        ("Laboratory", campaign.lab or "not named"),
        ("Measured", dates(measured)),
        ("Contains", ", ".join(counted(len(x), name) for x, name in counts)),
        ("Made by", tool),
        ("Input", measured.input_hash),
    )
    return Sheet(
        title=campaign.title,
        subtitle="Measured datasheet, compared with the prediction",
        name=f"{campaign.title} – measured datasheet",
        facts=facts,
        tool=tool,
        foot=f"{tool}, input {measured.input_hash}.{f' {mark}.' if mark else ''}",
        mark=mark,
        mark_note="A program made these runs. No sensor was measured." if campaign.simulated else "",
        date=max((run.date for run in campaign.runs if run.date is not None), default=None),
        blocks=_blocks(measured, groups),
    )


def _blocks(measured: CampaignReport, groups: list[ResinGroups]) -> list[SheetBlock]:
    aged = plots.ageings(measured)
    return [
        verdict_box(measured),
        Tiles(tiles(measured)),
        *section("Measured and predicted", Plots(_plots(measured, groups))),
        *([] if aged is None else section("Ageing", Columns(((aged,), (tables.ageing_table(measured),))))),
        *(block for group in groups for block in tables.resin_section(group)),
        *tables.lists(measured),
        *tables.specimen_section(groups),
        *section("Conditions", SheetTable(conditions(measured))),
        *section("Definitions", tables.definitions(), Text(_WHERE, "muted")),
    ]


def _plots(measured: CampaignReport, groups: list[ResinGroups]) -> list[Plot]:
    """The plots that have data, wide ones first."""
    draw = plots.sensitivities, plots.responses, plots.indentations, plots.loops, plots.relaxations
    drawn = [plot for plot in (one(groups) for one in draw) if plot is not None]
    if any(len(b.group.of_kind(kind)) > MOST_RUNS for b in measured.comparisons for kind in _KINDS):
        some = f" At most {MOST_RUNS} runs a group are drawn."
        drawn = [replace(one, caption=one.caption + some) if one.title != "Hysteresis" else one for one in drawn]
    return sorted(drawn, key=lambda plot: not plot.full)


_WORDS = ("passed", "failed", "not decided")


def dates(measured: CampaignReport) -> str:
    """First and last day of the runs; "undated" if no run states its date."""
    days = sorted(run.date for run in measured.campaign.runs if run.date is not None)
    if not days:
        return "undated"
    first, last = days[0].isoformat(), days[-1].isoformat()
    return first if first == last else f"{first} to {last}"


def verdict_box(measured: CampaignReport) -> FramedBlocks:
    """Box with the verdict on each requirement of the target, and notes on runs and parts that are not used."""
    rows: list[Row] = [
        [v.what, v.required, v.measured, Cell(word_of(v.passed, _WORDS), strong=True)] for v in measured.verdicts
    ]
    table = [SheetTable(rows, ("What", "Required", "Measured", "Verdict"))] if rows else []
    notes = Text(" ".join(_notes(measured)), "muted")
    return FramedBlocks(whole_verdict(measured.verdicts), [*table, notes])


def _notes(measured: CampaignReport) -> list[str]:
    """Notes on undecided verdicts, files that are not used, and doubtful parts of records."""
    failed, runs = len(measured.failures), len(measured.campaign.runs)
    suspect = [warning for curve in measured.curves for warning in curve.warnings if warning.kind != "note"]
    notes = []
    if any(v.passed is None for v in measured.verdicts):
        notes.append("Not decided: the interval holds values on both sides of the limit; more specimens would decide.")
    if failed:
        notes.append(f"Not used: {failed} of {counted(runs, 'run')}, see Failures.")
    else:
        notes.append(f"All {runs} runs were read." if runs > 1 else "The run was read.")
    if suspect:
        left = sum(not warning.used for warning in suspect)
        parts = counted(left, "doubtful part")
        notes.append(f"{parts} of the records left out, {len(suspect) - left} noted and used: see Warnings.")
    return notes


def whole_verdict(verdicts: tuple[Verdict, ...]) -> str:
    """Verdict on the whole target: failed if one requirement is, else undecided if one is, else passed."""
    if not verdicts:
        return "No target given"
    passed = [v.passed for v in verdicts]
    return f"Target {word_of(False if False in passed else None if None in passed else True, _WORDS)}"


def tiles(measured: CampaignReport) -> list[Tile]:
    """At most six tiles with the main figures, in a fixed order; those that were not measured are left out."""
    tiles = [_extent(measured, SENSITIVITY_KEY, "Sensitivity", "kPa/N"), *_against(measured)]
    for key, name in (("repeatability_kPa_per_N", "Repeatability"), ("part_to_part_kPa_per_N", "Part to part")):
        tiles.append(_worst(measured, key, name, "kPa/N", "standard deviation of the sensitivity"))
    tiles.append(_worst(measured, "hysteresis_width_percent", "Hysteresis", "% FS", "greatest width of the loop"))
    tiles.append(
        _worst(measured, "relaxation_force_percent", "Relaxation of the force", "%", "from 1 s to the end of the hold")
    )
    tiles.append(_worst(measured, "resolution_N", "Resolution", "N", "three standard deviations of the noise"))
    tiles.append(_extent(measured, STIFFNESS_KEY, "Mean stiffness", "N/mm"))
    tiles.append(_extent(measured, "force_range_N", "Force at the greatest depth", "N"))
    return [tile for tile in tiles if tile is not None][:6]


def _with(measured: CampaignReport, key: str) -> list[tuple[GroupComparison, Estimate]]:
    return [
        (comparison, comparison.group.figures[key])
        for comparison in measured.comparisons
        if key in comparison.group.figures
    ]


def _where(measured: CampaignReport, comparison: GroupComparison) -> str:
    """A group in words: driving pressure, its resin and age where there are several, and its age if not fresh."""
    key, keys = comparison.group.key, [other.group.key for other in measured.comparisons]
    resin = [comparison.label] if len({other.resin for other in keys}) > 1 else []
    age = [key.age] if key.age_days or len({other.age_days for other in keys}) > 1 else []
    return ", ".join([*resin, f"{key.driving_pressure_kPa:g} kPa", *age])


def _extent(measured: CampaignReport, key: str, name: str, unit: str) -> Tile | None:
    """Tile with the only value, or the least and the greatest over the groups; None if not measured."""
    pairs = _with(measured, key)
    if not pairs:
        return None
    low, high = min(pairs, key=lambda pair: pair[1].value), max(pairs, key=lambda pair: pair[1].value)
    if len(pairs) == 1:
        estimate = low[1]
        width = between((estimate.value, estimate.low, estimate.high))
        interval = f"; {width} (95 %)" if estimate.low is not None else "; one value, no interval"
        return Tile(name, number(estimate.value), unit, f"{_where(measured, low[0])}{interval}")
    ends = f"{number(low[1].value)} to {number(high[1].value)}"
    return Tile(name, ends, unit, f"least at {_where(measured, low[0])}, greatest at {_where(measured, high[0])}")


def _against(measured: CampaignReport) -> list[Tile]:
    """Tiles on measured against predicted sensitivities: differences, overlaps of intervals; [] if none predicted."""
    pairs = [
        (b, e, b.predicted[SENSITIVITY_KEY])
        for b, e in _with(measured, SENSITIVITY_KEY)
        if SENSITIVITY_KEY in b.predicted
    ]
    off = [(gap, b) for b, e, p in pairs if (gap := difference(e.value, p[0])) is not None]
    if not off:
        return []
    worst = max(off, key=lambda pair: abs(pair[0]))
    middle = number(median(abs(gap) for gap, _ in off), 2)
    words = f"median; most {signed(worst[0])} % at {_where(measured, worst[1])}"
    first = Tile("Off the predicted sensitivity", middle, "%", words)
    if len(off) == 1:
        first = Tile("Measured less predicted", signed(off[0][0]), "%", "of the predicted sensitivity")
    known = [within for _, e, p in pairs if (within := overlap((e.value, e.low, e.high), p)) is not None]
    if not known:
        return [first]
    band, words = f"{sum(known)} of {len(known)}", "groups whose 95 % interval meets the band"
    if len(known) == 1:
        band, words = word_of(known[0]), "95 % interval or value against 95 % band"
    return [first, Tile("In the predicted band", band, "", words)]


def _worst(measured: CampaignReport, key: str, name: str, unit: str, what: str) -> Tile | None:
    """Tile with the greatest value of a figure over the groups; None if not measured."""
    pairs = [pair for pair in _with(measured, key) if math.isfinite(pair[1].value)]
    if not pairs:
        return None
    comparison, estimate = max(pairs, key=lambda pair: pair[1].value)
    most = "greatest, " if len(pairs) > 1 else ""
    return Tile(name, number(estimate.value), unit, f"{what}; {most}{_where(measured, comparison)}")


def conditions(measured: CampaignReport) -> list[list[str]]:
    """Rows (quantity, value) on rig, air, runs and model."""
    campaign, rig, scene = measured.campaign, measured.campaign.rig, measured.scene
    kinds = Counter(run.kind for run in campaign.runs)
    ambient_kPa = campaign.ambient_pressure_kPa
    air = (
        f"{ambient_kPa:g} kPa absolute, as measured"
        if ambient_kPa is not None
        else (f"{scene.design.pneumatics.ambient_pressure_kPa:g} kPa absolute, as the design states")
    )
    design = scene.design.membrane
    keys = sorted((one.group.key for one in measured.comparisons), key=lambda key: key.age_days)
    return [
        ["Laboratory", campaign.lab or "not named"],
        ["Dates", dates(measured)],
        ["Design", f"{scene.name}: inner radius {design.inner_radius_mm:g} mm, wall {design.wall_thickness_mm:g} mm"],
        ["Rig", rig.name],
        ["Force sensor", f"to {rig.force_range_N:g} N, resolution {rig.force_resolution_N:g} N"],
        ["Pressure sensor", f"to {rig.pressure_range_kPa:g} kPa gauge"],
        ["Sampling", f"{rig.rate_Hz:g} Hz"],
        ["Ambient pressure", air],
        ["Runs", enumerated([f"{count} {kind}" for kind, count in sorted(kinds.items())])],
        ["Ages", enumerated(list({key.age_days: key.age for key in keys}.values())) or "none"],
        ["Driving pressure as read", _as_read(measured)],
        ["Predicted by", measured.model],
    ]


def _as_read(measured: CampaignReport) -> str:
    """Greatest distance of a run's driving pressure from its nominal one, in words."""
    off_kPa = [
        curve.driving / KPA - curve.run.driving_pressure_kPa
        for curve in measured.curves
        if math.isfinite(curve.driving)
    ]
    if not off_kPa:
        return "not read"
    worst_kPa = max(off_kPa, key=abs)
    return f"within {number(abs(worst_kPa), 2)} kPa of the nominal one in every run"
