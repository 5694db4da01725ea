"""Simulated measurements of a design."""

from pneutouch.workflows.simulate.named import named_design
from pneutouch.workflows.simulate.run import campaign_toml

__all__ = ["campaign_toml", "named_design"]
