"""A characterization as text."""

from typing import Any

from pneutouch.bench.figure import BY_KEY
from pneutouch.wording import SIMULATED


def measured_text(document: dict[str, Any]) -> str:
    """A table a group: measured with its interval, and the prediction; then the warnings."""
    head = f"{document['title']}: measured on {document['design']}, predicted by {document['model']}"
    lines = [head + (f"  {SIMULATED}" if document["simulated"] else "")]
    for group in document["groups"]:
        lines += ["", *_group(group)]
    for entry in document["target"]:
        word = {True: "met", False: "NOT met", None: "not decided"}[entry["passed"]]
        lines.append(f"\ntarget {word}: {entry['what']}: required {entry['required']}, measured {entry['measured']}")
    for change in document["ageing"]:
        lines.append(
            f"\nageing: {change['resin']}, {change['driving_pressure_kPa']:g} kPa, {change['age']}: "
            f"{change['sensitivity_change_percent']:+.1f} %"
        )
    for entry in document["injections"]:
        error = "" if entry["standard_error"] is None else f" ± {entry['standard_error']:.2g}"
        lines.append(f"\n{entry['sensor']}: {entry['figure']} {entry['value']:.4g}{error} {entry['unit']}")
    lines += _warnings(document["runs"])
    lines += [f"\nquestion: {entry['file']}: {entry['question']} The run is used." for entry in document["questions"]]
    return "\n".join(lines)


def _warnings(runs: list[dict[str, Any]]) -> list[str]:
    """Counts of the parts of the records that were left out, and of those that are noted but used."""
    every = [warning for run in runs for warning in run["warnings"] if warning["kind"] != "note"]
    left = sum(not warning["used"] for warning in every)
    if not every:
        return []
    words = f"{left} doubtful parts of the records left out, {len(every) - left} noted and used"
    return [f"\n{words}; see figures.json and evidence/"]


def _group(group: dict[str, Any]) -> list[str]:
    sensors = ", ".join(group["sensors"])
    lines = [f"{group['resin']}, {group['age']}, {group['driving_pressure_kPa']:g} kPa: {sensors}"]
    if group["why_not_predicted"]:
        lines.append(f"  not predicted: {group['why_not_predicted']}")
    for key, entry in group["figures"].items():
        figure = BY_KEY[key]
        interval = "" if entry["low"] is None else f"{entry['low']:.4g} to {entry['high']:.4g}"
        line = f"  {figure.name:<48} {entry['value']:>9.4g}  {interval:<22} {figure.unit}"
        if "predicted" in entry:
            line += f"  (predicted {entry['predicted']['value']:.4g})"
        lines.append(line.rstrip())
    return lines
