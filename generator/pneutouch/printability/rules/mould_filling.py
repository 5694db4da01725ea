"""Filling of a mould before its silicone sets: pour channel and vents against the viscosity and the pot life."""

from pneutouch.parts.mould import MouldAssembly
from pneutouch.parts.mould.filling import SYRINGE_KPA, MouldFilling, filling
from pneutouch.printability.finding import Excess, Finding, Severity

_SHARE = 0.5
"""Share of the pot life that filling may take, after mixing and degassing: own choice."""

_SOURCE = "slow flow of a Newtonian liquid through pour channel and wall (parts/mould/filling.py), half the pot life"
_UNKNOWN = "the material's file states no mixed_viscosity_Pa_s"
_BUBBLE = "rise of a free bubble as wide as a vent: Hadamard (1911), Rybczynski (1911); half the pot life: own choice"


def mould_filling(mould: MouldAssembly) -> MouldFilling | None:
    """Times of filling one cavity; None if the silicone's viscosity is not known."""
    material = mould.scene.membrane_material
    if material.casting is None or material.casting.mixed_viscosity_Pa_s is None:
        return None
    viscosity = material.casting.mixed_viscosity_Pa_s.most
    return filling(mould.size, viscosity, material.density_g_per_cm3.nominal)


def check(mould: MouldAssembly) -> list[Finding]:
    """Compare the times of all cavities, one after another, with half of the pot life."""
    casting = mould.scene.membrane_material.casting
    times = mould_filling(mould)
    if casting is None:
        return []
    if times is None:
        text = "how long it takes to fill is not known"
        return [Finding("mould filling", "note", "mould", text, "measure the viscosity", _UNKNOWN)]
    limit, cavities = _SHARE * 60 * casting.pot_life_min.least, mould.size.shape.cavities
    syringe, findings = cavities * times.syringe_s, []
    if times.pour_s > limit:
        severity: Severity = "warning" if syringe > limit else "note"
        text = (
            f"poured through the channel it fills in {times.pour_s / 60:.0f} min; half the pot life is "
            f"{limit / 60:.0f} min; a syringe at {SYRINGE_KPA:g} kPa fills it in {syringe:.0f} s"
        )
        fix = "fill the open cap and ring and lower the core, or press the silicone in with a syringe"
        if severity == "warning":
            fix = "widen mould.sprue_diameter_mm, take fewer mould.cavities, or fill the open cap and lower the core"
        findings.append(
            Finding("mould filling", severity, "mould-core", text, fix, _SOURCE, None, Excess(times.pour_s, limit, "s"))
        )
    if times.bubble_s > limit:
        text = (
            f"a bubble as wide as a vent takes {times.bubble_s / 60:.0f} min to rise out, half the pot life is "
            f"{limit / 60:.0f} min: smaller ones stay in the wall"
        )
        fix = "degas the mixed silicone in vacuum, or widen mould.vent_diameter_mm"
        excess = Excess(times.bubble_s, limit, "s")
        findings.append(Finding("mould filling", "warning", "mould-core", text, fix, _BUBBLE, None, excess))
    return findings
