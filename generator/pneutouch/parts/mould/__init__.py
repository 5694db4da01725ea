"""Moulds of cast membranes: cap, ring, core and base, drawn from the membrane's own meridian."""

from pneutouch.parts.mould.assembly import MouldAssembly, SiliconeBatch, mould_of, silicone_batch

__all__ = ["MouldAssembly", "SiliconeBatch", "mould_of", "silicone_batch"]
