"""Moulds of cast membranes: cap, ring, core and base, drawn from the membrane's own meridian."""

from pneutouch.parts.mould.assembly import MouldAssembly, mould_of
from pneutouch.parts.mould.silicone import SiliconeBatch, silicone_batch

__all__ = ["MouldAssembly", "SiliconeBatch", "mould_of", "silicone_batch"]
