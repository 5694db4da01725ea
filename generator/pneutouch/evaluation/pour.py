"""Silicone to weigh for a cast membrane."""

from pneutouch.evaluation.sheet_data import SiliconePour
from pneutouch.parts import Assembly
from pneutouch.parts.mould import silicone_batch


def silicone_pour(assembly: Assembly) -> SiliconePour | None:
    """The batch that fills the mould once; None if the membrane is not cast."""
    if assembly.mould is None:
        return None
    batch = silicone_batch(assembly.mould)
    note = (
        f"{batch.volume_mL:.1f} mL, {batch.cavities} x (cavity {batch.cavity_mL:.2f} + channels "
        f"{batch.channels_mL:.2f} + overflow {batch.overflow_mL:.2f} mL) and {batch.loss_mL:.1f} mL left in the cup"
    )
    return SiliconePour(batch.volume_mL, batch.mass_g, batch.parts_g, note)
