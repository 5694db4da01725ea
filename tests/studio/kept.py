"""What a page keeps after its garbage was collected, as the browser counts it."""

from __future__ import annotations

from typing import NamedTuple

from playwright.sync_api import Page


class Kept(NamedTuple):
    """Objects and memory of a page: elements and texts, listeners of events, frames, and the scripts' memory in MB."""

    nodes: int
    listeners: int
    documents: int
    scripts_mb: float

    @classmethod
    def of(cls, page: Page) -> Kept:
        """Counted now, after a collection."""
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable")
        # What a finalizer lets go is collected by the second.
        for _ in range(2):
            session.send("HeapProfiler.collectGarbage")
        found = {each["name"]: each["value"] for each in session.send("Performance.getMetrics")["metrics"]}
        session.detach()
        counts = (int(found[name]) for name in ("Nodes", "JSEventListeners", "Documents"))
        return cls(*counts, found["JSHeapUsedSize"] / 1e6)
