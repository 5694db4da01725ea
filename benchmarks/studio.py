"""From a slider's move to what is painted, in Chromium, over the same way with an echo for an answer; and page weight.

Run as ``python -m benchmarks.studio [MOVES]``; it prints medians and 95th percentiles in milliseconds, their ratio to the
echo's in the same run, and the memory of the page's scripts before and after.
"""

from __future__ import annotations

import gzip
import statistics
import sys
import tempfile
from importlib.resources import files
from pathlib import Path

from tests.report.browser import WITH_WEBGL, Browser, browser
from tests.studio.served import served, until

_ANSWERED = "document.getElementById('status')?.textContent?.startsWith('Answered by the model')"
_MOVES = """(async () => {{
const slider = document.querySelector('[aria-label="Wall thickness, mm"]'), times = [];
for (let k = 0; k < {count}; k += 1) {{
  const before = document.body.dataset.painted, start = performance.now();
  slider.value = 262 + (k * 7) % 36;
  slider.dispatchEvent(new Event('input'));
  while (document.body.dataset.painted === before) await new Promise(done => setTimeout(done, 0));
  times.push(performance.now() - start);
}}
return times; }})()"""
_ECHOES = """(async () => {{
const times = [], body = JSON.stringify({{base: 'paper-dome', values: {{'membrane.wall_thickness_mm': '1.4'}}}});
for (let k = 0; k < {count}; k += 1) {{
  const start = performance.now();
  await (await fetch('/api/echo', {{method: 'POST', headers: {{'Content-Type': 'application/json'}}, body}})).json();
  await new Promise(done => requestAnimationFrame(done));
  times.push(performance.now() - start);
}}
return times; }})()"""


def percentile(times: list[float]) -> float:
    """The 95th."""
    return statistics.quantiles(times, n=20)[-1]


def memory(page: Browser) -> float:
    """What the page's scripts keep, MB."""
    page.call("HeapProfiler.collectGarbage")
    return page.call("Runtime.getHeapUsage")["usedSize"] / 1e6


def weight() -> int:
    """Bytes of the page's files, compressed as they are served."""
    static = files("pneutouch.studio") / "static"
    names = [*static.iterdir(), *(static / "vendor").iterdir()]
    kinds = (".html", ".css", ".js", ".svg")
    return sum(len(gzip.compress(each.read_bytes(), 9)) for each in names if each.name.endswith(kinds))


def main(count: int) -> None:
    with served() as (address, _), browser(Path(tempfile.mkdtemp()), *WITH_WEBGL) as page:
        page.visit(address, 1400)
        until(page, _ANSWERED)
        echoes = page.evaluate(_ECHOES.format(count=count))
        before = memory(page)
        moves = page.evaluate(_MOVES.format(count=count))
        until(page, _ANSWERED)
        after = memory(page)
    for name, times in (("echo", echoes), ("move", moves)):
        print(f"{name}: median {statistics.median(times):.0f} ms, 95th percentile {percentile(times):.0f} ms")
    print(f"ratio of the 95th percentiles: {percentile(moves) / percentile(echoes):.1f}")
    print(f"memory of scripts: {before:.1f} MB before, {after:.1f} MB after {count} moves")
    print(f"page weight: {weight() / 1e6:.3f} MB compressed")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
