"""The atlas corrected by the solid for sensors that it does not cover: figures, curves, and figures of many designs."""
