"""
Why does the check reject this dome?
====================================

``check`` compares each feature with what the printer can make and the gas can do. The first dome has a wall that is
too thin; the second is mended as the finding states. The picture shows what was measured against its limit.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("paper-dome").replace("mended", driving_pressures_kPa=[0], checked_waves=0)
bad = design.replace("too-thin", wall_thickness_mm=0.3)

rows = []
for each in (bad, design):
    result = each.check()
    print(f"{each.name}: {'passed' if result.passed else 'not passed'}")
    for finding in result.findings:
        excess = finding.excess
        print(f"  {finding.severity}, {finding.rule}: {finding.message}")
        if excess is not None and finding.severity != "note":
            rows.append((f"{each.name}: {finding.rule}, {finding.body}", excess.measured / excess.limit, finding))

figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
greys = {"error": "k", "warning": "0.6"}
for place, (_, share, finding) in enumerate(rows):
    axes.barh(place, share, color=greys[finding.severity])
for severity, grey in greys.items():
    axes.barh(0, 0, color=grey, label=severity)
axes.axvline(1, color="k", ls="--", lw=1, label="limit")
axes.set_yticks(range(len(rows)), [row[0] for row in rows])
axes.invert_yaxis()
axes.set(xlabel="measured over limit (-)", ylabel="rule and body")
axes.legend()
