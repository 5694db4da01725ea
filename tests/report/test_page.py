"""The page of the datasheet: complete in itself, small, for narrow screens and for paper, and whole without WebGL."""

from __future__ import annotations

import base64
import io
import json
import re

import numpy as np
import pytest

from pneutouch.report import pages
from pneutouch.report.pages import TEMPLATES

MOST_BYTES = 1_000_000


@pytest.fixture(scope="module")
def html(built):
    return (built("paper-dome") / "datasheet.html").read_text(encoding="utf-8")


def test_the_page_is_at_most_a_megabyte_and_needs_nothing_from_outside(html):
    assert len(html.encode()) <= MOST_BYTES
    named = re.findall(r"""(?:src|href|srcset|action)\s*=\s*["']?([^"'\s>]+)""", html)
    assert all(address.startswith(("data:", "#")) for address in named)
    assert all(address.startswith(("data:", "#")) for address in re.findall(r"url\(([^)]+)\)", html))
    assert "@import" not in html
    assert "<iframe" not in html


def test_every_id_stands_once_and_whatever_is_named_is_there(html):
    ids = re.findall(r'\bid="([^"]+)"', html)
    drawn = re.sub(r"<script.*?</script>", "", html, flags=re.DOTALL)
    used = set(re.findall(r'href="#([^"]+)"', drawn)) | set(re.findall(r"url\(#([^)]+)\)", drawn))
    assert used <= set(ids)
    assert all(ids.count(name) == 1 for name in used)


def test_the_page_is_told_the_width_of_the_screen_and_how_to_print(html):
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in html
    style = html[html.index("<style>") : html.index("</style>")]
    printed = style[style.index("@media print") :]
    assert "body { background: #fff" in printed
    assert "overflow" not in printed
    assert not re.search(r"overflow(-x)?: (auto|scroll)", style)
    for kept in ("tr,", "figure,", ".tiles,", ".view,"):
        assert kept in printed[: printed.index("break-inside: avoid")]
    assert "display: table-header-group" in printed


def test_without_webgl_the_picture_stays_and_no_error_leaves_the_script(html):
    """The picture is in the page itself; the script shows its canvas once it has drawn and catches what fails."""
    import matplotlib.image

    view = html[html.index('<div class="view" id="view">') :]
    source = re.match(r'<div class="view" id="view"><img src="data:image/png;base64,([^"]+)" alt="[^"]{10,}">', view)
    assert source is not None
    image = matplotlib.image.imread(io.BytesIO(base64.b64decode(source[1])), format="png")
    assert image.shape[:2] == (640, 900)
    assert np.ptp(image[..., :3]) > 0.5
    script = (TEMPLATES / "viewer.js").read_text().strip()
    assert script in html
    body = script[: script.rindex("try { begin(); } catch (error)")]
    # Until `begin` is called nothing but functions, numbers and the two elements is made.
    assert body.count("getContext") == 1
    begin = body[body.index("function begin()") :]
    assert begin.index("if (!gl) return;") < begin.index("program(gl)") < begin.index('box.classList.add("live")')
    assert body.count('add("live")') == 1
    assert "webglcontextlost" in script


def test_the_view_of_the_page_is_read_as_json(html):
    text = re.search(r'<script type="application/json" id="view-data">(.*?)</script>', html, re.DOTALL)
    assert text is not None
    assert [part["name"] for part in json.loads(text[1])["bodies"]] == ["membrane", "connector"]


def test_letters_are_defined_once_and_no_figure_loses_any():
    letter, other = '<path id="a" d="M 0 0"/>', '<path id="b" d="M 1 1" transform="scale(1)"/>'
    seen: set[str] = set()
    assert pages.without_repeats(f"<svg>{letter}{other}</svg>", seen) == f"<svg>{letter}{other}</svg>"
    assert pages.without_repeats(f'<svg>{letter}<use href="#a"/></svg>', seen) == '<svg><use href="#a"/></svg>'


def test_cells_of_wide_tables_name_their_column(html):
    table = html[html.index("<h2>Performance</h2>") :]
    table = table[: table.index("</table>")]
    assert 'data-of="Sensitivity, kPa/N"' in table
    rows = table[table.index("<tbody>") :].split("<tr")[1:]
    assert all(row.count("data-of=") == row.count("<td") == 11 for row in rows)
