"""The atlas corrected by the solid for another contact: over driving pressures, travels, and designs."""
