"""How much silicone to weigh for a cast membrane."""

from pneutouch.evaluation.sheet_data import SiliconePour
from pneutouch.parts import Assembly
from pneutouch.units import ML, grams


def silicone_pour(assembly: Assembly) -> SiliconePour | None:
    """The batch for one membrane; None where it is not cast."""
    solid = assembly.solid("membrane")
    casting = solid.material.casting
    if casting is None or not assembly.scene.printer.is_casting:
        return None
    volume_mL = solid.volume / ML
    mass_g = grams(solid.volume, solid.material.density_g_per_cm3.nominal)
    note = f"the membrane alone takes {volume_mL:.2f} mL; add what stays in sprue, vents and cup"
    return SiliconePour(volume_mL, mass_g, tuple(casting.masses_g(mass_g)), note)
