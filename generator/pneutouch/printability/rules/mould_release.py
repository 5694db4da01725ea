"""Release of the cured membrane from its core: the strain that it needs against its elongation at break."""

from pneutouch.parts.mould import MouldAssembly
from pneutouch.parts.mould.release import SAFETY, release_of
from pneutouch.printability.finding import Excess, Finding

_SOURCE = (
    "greatest diameter of the core over the smallest opening of the membrane, and the wall rolled back over itself; "
    f"a factor of {SAFETY:g} to the elongation at break: own choice"
)


def check(mould: MouldAssembly) -> list[Finding]:
    """Compare the strain needed, times `SAFETY`, with the elongation at break."""
    release = release_of(mould.membrane, mould.size)
    needed = 100 * SAFETY * release.strain
    broken = mould.scene.membrane_material.elongation_at_break_percent
    if broken is None:
        text = f"it must stretch by {100 * release.strain:.0f} % to leave its core; how far it may is not known"
        fix = "give elongation_at_break_percent in the material's file"
        return [Finding("release", "note", "membrane", text, fix, _SOURCE)]
    if needed <= broken.least:
        return []
    text = (
        f"it must stretch by {100 * release.strain:.0f} % to leave its core, {needed:.0f} % with a factor of "
        f"{SAFETY:g}; it breaks at {broken.least:.0f} %"
    )
    passing = release.passing_strain >= release.strain
    fix = "lower mould.draft_deg or mould.shrinkage_percent" if passing else "take a membrane.material that stretches"
    return [Finding("release", "error", "membrane", text, fix, _SOURCE, None, Excess(needed, broken.least, "%"))]
