"""The measured datasheet: one HTML page and one PDF from the same content and the same figures."""

from collections.abc import Sequence

from pneutouch.report import pages
from pneutouch.report.measured import head, plots, tables
from pneutouch.report.measured.panels import MOST_RUNS, CampaignReport, Panel, Plot, panels_of
from pneutouch.results.record import plain

_RUNS_ONLY = ("steps", "saturation", "loop", "relaxation")


def measured_datasheet(measured: CampaignReport) -> dict[str, bytes]:
    """``measured-datasheet.html`` and ``measured-datasheet.pdf``; the same bytes for the same campaign."""
    panels = panels_of(measured.comparisons)
    drawn = _figures(measured, panels)
    entries = [
        {"name": n, "title": title, "caption": words, "wide": plot.wide} for n, (title, words, plot) in drawn.items()
    ]
    content = {
        **head.head(measured),
        "verdict": head.verdict(measured),
        "tiles": head.tiles(measured),
        "resins": [tables.resin_table(panel) for panel in panels],
        "ageing": tables.ageing(measured),
        "injections": tables.injections(measured),
        "specimens": tables.specimens(panels),
        "failures": tables.failures(measured),
        "questions": tables.questions(measured),
        "warnings": tables.warning_rows(measured),
        "conditions": head.conditions(measured),
        "definitions": tables.rows(),
        "where": tables.WHERE,
        "figures": entries,
    }
    figures = {name: plot.svg for name, (_, _, plot) in drawn.items()}
    days = [run.date for run in measured.campaign.runs if run.date is not None]
    return {
        "measured-datasheet.html": pages.html("measured.html.j2", content, figures).encode(),
        "measured-datasheet.pdf": pages.pdf("measured.typ", plain(content), figures, max(days, default=None)),
    }


DrawnPlots = dict[str, tuple[str, str, Plot]]


def _figures(measured: CampaignReport, panels: Sequence[Panel]) -> DrawnPlots:
    """Title, caption and plot by name; plots without data are left out, wide ones stand first."""
    thinned = any(len(b.group.of_kind(kind)) > MOST_RUNS for b in measured.comparisons for kind in _RUNS_ONLY)
    some = f" At most {MOST_RUNS} runs a group are drawn." if thinned else ""
    many = panels and len(panels[0].campaign_pressures_kPa) > 2
    ends = " at the lowest and the highest driving pressure" if many else ""
    lines = " Thin lines join the points of runs without a prediction."
    joined = lines if any(b.state is None for b in measured.comparisons) else ""
    listed = {
        "sensitivity": (
            "Sensitivity over driving pressure",
            "Mean over specimens with its 95 % interval, in the predicted band.",
            plots.sensitivities(panels),
        ),
        "response": (
            "Response",
            "Pressure rise over contact force. Markers: every run; lines: predicted, with the band of the "
            f"sensitivity{ends}.{joined}{some}",
            plots.responses(panels),
        ),
        "indentation": (
            "Force over indentation",
            "Contact force over indentation. Markers: every run; lines: predicted, with the band of the "
            f"stiffness{ends}.{joined}{some}",
            plots.indentations(panels),
        ),
        "loops": (
            "Hysteresis",
            "Pressure rise over contact force: the first run at the lowest and at the highest driving pressure, all "
            "its cycles.",
            tables.loops(panels),
        ),
        "relaxation": (
            "Relaxation",
            f"Force and pressure rise in a long hold, in percent of their value at 1 s; every driving pressure.{some}",
            tables.relaxations(panels),
        ),
        "ageing": (
            "Ageing",
            "Change of the sensitivity since fresh, in percent of the aged one, with its 95 % interval.",
            tables.ageings(measured),
        ),
    }
    drawn = {name: (title, caption, plot) for name, (title, caption, plot) in listed.items() if plot is not None}
    return dict(sorted(drawn.items(), key=lambda item: not item[1][2].wide))
