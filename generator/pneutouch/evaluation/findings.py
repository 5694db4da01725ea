"""Findings of the print rules on a sensor and, where its membrane is cast, on its mould."""

from dataclasses import replace

from pneutouch.evaluation.subject import glued_seat, subject_of, wetted
from pneutouch.parts import Assembly
from pneutouch.printability import Finding, SensorContext, check
from pneutouch.printability.mould import check_mould


def sensor_findings(assembly: Assembly, context: SensorContext) -> list[Finding]:
    """All findings, errors first. A calibrated membrane is cast already: its mould is left aside.

    Raises InputError if a detail of the mould has no space.
    """
    context = replace(context, glued=glued_seat(assembly.scene))
    if assembly.mould is None or context.calibrated:
        return check(subject_of(assembly), context)
    findings = check(subject_of(assembly), replace(context, wetted=wetted(assembly)))
    return sorted([*findings, *check_mould(assembly.mould)], key=lambda finding: finding.rank)
