"""The measured datasheet: its sections in order, as a page and as a PDF."""

from dataclasses import replace

from pneutouch import __version__
from pneutouch.report.blocks import Columns, Plot, Plots, Sheet, SheetBlock, SheetTable, Text, Tiles, section
from pneutouch.report.measured import head, plots, tables
from pneutouch.report.measured.groups import MOST_RUNS, CampaignReport, ResinGroups, groups_of
from pneutouch.report.pages import set_sheet
from pneutouch.wording import SIMULATED, counted

_KINDS = ("steps", "saturation", "loop", "relaxation")
_WHERE = "Formulas, units and sources: docs/howto/measuring.md, section Definitions."


def measured_datasheet(measured: CampaignReport) -> dict[str, bytes]:
    """``measured-datasheet.html`` and ``measured-datasheet.pdf``; the same bytes for the same campaign."""
    return set_sheet(described(measured), "measured-datasheet")


def described(measured: CampaignReport) -> Sheet:
    """The whole sheet, its plots drawn."""
    campaign, groups = measured.campaign, groups_of(measured.comparisons)
    resins, sensors = {run.resin for run in campaign.runs}, {run.sensor for run in campaign.runs}
    counts = (sensors, "specimen"), (campaign.runs, "run"), (resins, "resin")
    tool, mark = f"pneutouch {__version__}", SIMULATED if campaign.simulated else ""
    facts = (
        ("Design", f"{measured.scene.name}, {measured.scene.design.document.title}"),
        ("Laboratory", campaign.lab or "not named"),
        ("Measured", head.dates(measured)),
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
    table = tables.ageing_table(measured)
    return [
        head.verdict_box(measured),
        Tiles(head.tiles(measured)),
        *section("Measured and predicted", Plots(_plots(measured, groups))),
        *([] if aged is None else section("Ageing", Columns(((aged,), (table,))))),
        *(block for group in groups for block in tables.resin_section(group)),
        *tables.lists(measured),
        *tables.specimen_section(groups),
        *section("Conditions", SheetTable(head.conditions(measured))),
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
