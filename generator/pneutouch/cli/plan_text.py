"""A test plan as text for people."""

from typing import Any

from pneutouch.cli.text import columns


def plan_text(document: dict[str, Any]) -> str:
    """The tests with their times, and the greatest values expected of each resin at each driving pressure."""
    tests = [
        [
            kind,
            ", ".join(f"{p:g}" for p in test["driving_pressures_kPa"]),
            str(test["runs"]),
            f"{max(test['depths_mm']):.2f}",
            f"{test['duration_s'] / 60:.1f}",
        ]
        for kind, test in document["tests"].items()
    ]
    rows = []
    for resin in document["resins"]:
        for state in resin["states"]:
            known = [point for point in state["points"] if point["force_N"] is not None]
            last = known[-1] if known else None
            rows.append(
                [
                    resin["resin"],
                    f"{state['driving_pressure_kPa']:g}",
                    *(
                        ["-"] * 3
                        if last is None
                        else [f"{last[key]:.2f}" for key in ("depth_mm", "force_N", "pressure_rise_kPa")]
                    ),
                    resin["model"],
                ]
            )
    count, sensors = len(document["runs"]), len(document["sensors"])
    return "\n".join(
        [
            f"{document['design']}: {count} runs on {sensors} specimens, {document['total_s'] / 3600:.1f} h on "
            f"{document['rig']['name']}",
            "",
            columns(["test", "at kPa", "runs", "depth mm", "min a run"], tests),
            "",
            columns(["resin", "kPa", "to mm", "N", "rise kPa", "model"], rows),
        ]
    )
