"""From a slider's move to what is painted, in Chromium, over the same way with an echo for an answer; and page weight.

Run as ``python -m benchmarks.studio [--moves N]``; it prints medians and 95th percentiles in milliseconds, their ratio to the
echo's in the same run, and what the page keeps at ten points of the moves.
"""

from __future__ import annotations

import argparse
import gzip
import statistics
from importlib.resources import files

from tests.browser import Pages, launched, until
from tests.studio.kept import Kept
from tests.studio.served import SOLVED, Studio, served

# Waits by an observer: polling would take one of two processors.
_MOVES = """(async () => {{
const slider = document.querySelector('[aria-label="Wall thickness, mm"]'), times = [];
const painted = () => new Promise(done => {{
  const observer = new MutationObserver(() => {{ observer.disconnect(); done(); }});
  observer.observe(document.body, {{ attributes: true, attributeFilter: ['data-painted'] }});
}});
for (let k = 0; k < {count}; k += 1) {{
  const start = performance.now(), next = painted();
  slider.value = 262 + (k * 7) % 36;
  slider.dispatchEvent(new Event('input'));
  await next;
  times.push(performance.now() - start);
}}
return times; }})()"""
_ECHOES = """(async () => {{
const times = [], body = JSON.stringify({{base: 'paper-dome', values: {{'membrane.wall_thickness_mm': '1.4'}}}});
const headers = {{'Content-Type': 'application/json', 'pneutouch-key': localStorage.getItem('pneutouch-key')}};
for (let k = 0; k < {count}; k += 1) {{
  const start = performance.now();
  await (await fetch('/api/echo', {{method: 'POST', headers, body}})).json();
  await new Promise(done => requestAnimationFrame(done));
  times.push(performance.now() - start);
}}
return times; }})()"""


# As Chromium draws where there is no graphics card: the page by the processor, and WebGL by it when something is drawn.
_BY_PROCESSOR = ("--enable-unsafe-swiftshader",)

_FIRST_PAINT = """new Promise((done) => new PerformanceObserver((list) => {
const found = list.getEntriesByName('first-contentful-paint');
if (found.length) done(found[0].startTime); }).observe({type: 'paint', buffered: true}))"""


def percentile(times: list[float]) -> float:
    """The 95th."""
    return statistics.quantiles(times, n=20)[-1]


def weight() -> int:
    """Bytes of the page's files, compressed as they are served."""
    static = files("pneutouch.studio") / "static"
    names = [*static.iterdir(), *(static / "vendor").iterdir()]
    kinds = (".html", ".css", ".js", ".svg")
    return sum(len(gzip.compress(each.read_bytes(), 9)) for each in names if each.name.endswith(kinds))


def main(count: int) -> None:
    with served() as (address, process), launched(*_BY_PROCESSOR) as browser:
        page = Studio(address, process).open(Pages(browser))
        until(page, SOLVED)
        assert page.locator("#view canvas").count() == 1
        first_paint = page.evaluate(_FIRST_PAINT)
        echoes = page.evaluate(_ECHOES.format(count=min(count, 200)))
        moves: list[float] = []
        print("   moves     nodes  listeners  scripts, MB")
        for point in range(11):
            kept = Kept.of(page)
            print(f"{len(moves):8d}  {kept.nodes:8d}  {kept.listeners:9d}  {kept.scripts_mb:11.2f}", flush=True)
            if point < 10:
                moves += page.evaluate(_MOVES.format(count=max(1, count // 10)))
                until(page, SOLVED)
    print(f"first contentful paint: {first_paint:.0f} ms after the address was entered")
    for name, times in (("echo", echoes), ("move", moves)):
        print(f"{name}: median {statistics.median(times):.0f} ms, 95th percentile {percentile(times):.0f} ms")
    print(f"ratio of the 95th percentiles: {percentile(moves) / percentile(echoes):.1f}")
    print(f"page weight: {weight() / 1e6:.3f} MB compressed")


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--moves", type=int, default=200)
    main(options.parse_args().moves)
