"""What leaves the program, and that the page in docs says what the code gives."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.uncertainty.document import document, gas_text, text
from pneutouch.results.record import plain as data
from tests.mechanics.test_contact import PAPER
from tests.mechanics.uncertainty.designs import budget_for

SENSITIVITY = "sensitivity_kPa_per_N"


@pytest.fixture(name="paper")
def _paper(library):
    return budget_for(library, batch_of(PAPER, [0.0, 0.012, 0.022]), "TangoPlus", True)


def test_the_document_is_plain_and_consistent(paper):
    content = data(document(paper, 1, notes=gas_text(batch_of(PAPER, [0.012]))[0]))
    assert json.loads(json.dumps(content, allow_nan=False)) == content
    assert content["coverage_factor"] == 2
    for name, figure in content["figures"].items():
        assert figure["low"] <= figure["value"] <= figure["high"], name
        assert figure["low"] * figure["high"] == pytest.approx(figure["value"] ** 2)
        assert figure["expanded_uncertainty"] == pytest.approx(0.5 * (figure["high"] - figure["low"]), abs=1e-12)
        assert sum(figure["shares"].values()) == pytest.approx(1.0 if figure["shares"] else 0.0)
        assert list(figure["shares"].values()) == sorted(figure["shares"].values(), reverse=True)
    assert all(source["origin"] for source in content["sources"])
    assert any("kPa/K" in note for note in content["notes"])


def test_another_models_value_keeps_the_relative_uncertainty(paper):
    own, other = data(document(paper, 0)), data(document(paper, 0, values={SENSITIVITY: 4.0}))
    ratio = 4.0 / own["figures"][SENSITIVITY]["value"]
    for key in ("low", "high", "expanded_uncertainty"):
        assert other["figures"][SENSITIVITY][key] == pytest.approx(ratio * own["figures"][SENSITIVITY][key])


def test_the_sentence_names_the_greatest_share(paper):
    assert "measure first: ageing" in text(paper, 0)


def test_the_page_says_what_the_code_gives(library, root):
    page = (root / "docs/background/uncertainty.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) kPa \| ([\d.]+) \| ([\d.]+) to ([\d.]+) \| (\d+) % \| (\d+) % \|", page, re.MULTILINE)
    assert [row[0] for row in rows] == ["0", "12", "22"]
    found = budget_for(library, batch_of(PAPER, [0.0, 0.012, 0.022]), "TangoPlus", True)
    for k, row in enumerate(rows):
        figure = data(document(found, k))["figures"][SENSITIVITY]
        said = [float(word) for word in row[1:]]
        shares = [100 * figure["shares"][name] for name in ("ageing", "model")]
        given = [figure["value"], figure["low"], figure["high"], *shares]
        assert said == pytest.approx(given, abs=2.0)
        assert np.allclose(said[:3], given[:3], rtol=0.005), (
            "half a per cent: another atlas may read that much otherwise"
        )


def test_the_pages_example_runs_and_says_what_it_says(root, capsys):
    page = (root / "docs/background/uncertainty.md").read_text(encoding="utf-8")
    examples = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", page, re.DOTALL)
    assert len(examples) == 2
    for code, said in examples:
        exec(code, {})
        words = capsys.readouterr().out.split()
        assert [w for w in words if w.isalpha()] == [w for w in said.split() if w.isalpha()]
