"""A calibration as text for people."""

from pneutouch.cli.table import table_text
from pneutouch.wording import counted
from pneutouch.workflows.calibrate.record import EstimateRecord, OutcomeRecord, ResponseRecord
from pneutouch.workflows.characterize.reading import same_failures


def calibration_text(document: OutcomeRecord) -> str:
    """The estimates and the design's values, the goodness of the fit, warnings, notes, and the files written."""
    rows = [
        [e["key"], f"{e['value']:.4g}", _interval(e), f"designed {e['designed']:.4g}"] for e in document["estimates"]
    ]
    fit = document["fit"]
    head = (
        f"{document['sensor']}, {document['design']}: {counted(document['runs'], 'curve')}, "
        f"{counted(document['injections'], 'injection')}, {counted(fit['points_used'], 'value')}"
    )
    chi = fit["chi_squared_per_degree"]
    parts = [
        head,
        table_text([], rows),
        "" if chi is None else f"chi-squared per degree of freedom: {chi:.2f}",
        _response(document["response"]),
        "\n".join(f"warning: {warning}" for warning in document["warnings"]),
        "\n".join(f"note: {note}" for note in document["notes"]),
        "\n".join(f"not used: {files}: {why}" for files, why in same_failures(document["failures"])),
        "\n".join(f"written: {path}" for path in document["written"]),
    ]
    return "\n\n".join(part for part in parts if part)


def _response(response: list[ResponseRecord]) -> str:
    if not response:
        return "no curves: the model's error in sensitivity stays that of the resin"
    head = ["kPa", "force times", "pressure rise times", "sensitivity", "error left in it"]
    rows = [
        [
            f"{row['driving_pressure_kPa']:g}",
            f"{row['force_factor']:.4f}",
            f"{row['pressure_factor']:.4f}",
            f"{row['pressure_factor'] / row['force_factor'] - 1:+.1%}",
            f"{row['sensitivity_error_relative']:.1%}",
        ]
        for row in response
    ]
    return f"correction of the fitted model (errors are standard uncertainties):\n{table_text(head, rows)}"


def _interval(estimate: EstimateRecord) -> str:
    interval = estimate["interval_95"]
    if interval is None:
        return "on its bound, no interval" if estimate["on_bound"] else "no interval"
    return f"95 %: {interval[0]:.4g} to {interval[1]:.4g}"
