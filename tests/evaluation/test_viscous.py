"""Relaxation, hysteresis and ageing as a user meets them: JSON, text, page, refusals; and what light commands do not load."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

from pneutouch.catalogue import Library
from pneutouch.cli.prediction_text import prediction_text
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.relaxation import viscous, viscous_runs
from pneutouch.evaluation.result import predicted_in_full
from pneutouch.evaluation.sheet import ageing_data, sheet_data
from pneutouch.mechanics.viscous.describe import ageing_ratio
from pneutouch.output.files import json_bytes
from pneutouch.report import relaxation
from pneutouch.report.blocks import Items, Plot, SheetTable, found
from pneutouch.results.record import plain as data
from tests.conftest import ROOT
from tests.mechanics.viscous.tables import PAPER_RESINS, agilus_table, friction_table, resin, wall_table


@pytest.fixture(scope="module")
def agilus(evaluated):
    return evaluated("agilus-dome", model="atlas")


def test_every_state_has_figures_of_all_sources(agilus):
    found = data(viscous(agilus.viscous_runs))
    assert len(found["sources"]) == 3
    assert [state["driving_pressure_kPa"] for state in found["states"]] == pytest.approx([0, 10, 20])
    assert found["depth_mm"] == 5.0
    for state in found["states"]:
        first, second, third = state["by_source"]
        # Near the glass transition, by the master curve at 20 C.
        assert third["hysteresis"][-1]["width_percent"] > 30
        for one in (first, second, third):
            held = one["relaxation"]
            assert 0 < held["pressure_rise_loss_percent"] < held["force_loss_percent"] < 100
            # 2.78 decades from 1 to 600 s.
            per_decade = held["force_loss_percent"] / np.log10(600)
            assert held["force_loss_percent_per_decade"] == pytest.approx(per_decade, rel=0.25)
            for turn in one["hysteresis"]:
                assert 0 < turn["width_percent"] < 100
        assert first["relaxation"]["force_loss_percent"] < second["relaxation"]["force_loss_percent"]


def test_the_same_prediction_has_the_same_bytes(agilus, library):
    again = evaluate("agilus-dome", model="atlas", library=library)
    assert json_bytes(data(predicted_in_full(agilus))) == json_bytes(data(predicted_in_full(again)))


@pytest.mark.parametrize("name", PAPER_RESINS)
def test_for_the_papers_resins_nothing_is_predicted_and_no_other_is_put_in_their_place(name, library):
    evaluation = evaluate(
        "paper-dome",
        {"membrane.material": name, "pneumatics.driving_pressures_kPa": [0]},
        model="atlas",
        library=library,
    )
    found = data(viscous(evaluation.viscous_runs))
    title = resin(library, name).title
    assert found == {"unknown": f"no relaxation data for {title}; no other resin's are put in their place"}


def test_the_membrane_and_a_sensor_outside_the_atlas_say_why(library, agilus):
    by_membrane = evaluate("agilus-dome", model="membrane", library=library)
    assert "membrane" in viscous(by_membrane.viscous_runs).unknown
    odd = replace(agilus, sensor=agilus.sensor.replace(poisson_ratio=0.45))
    assert "outside the atlas: Poisson" in viscous(odd.viscous_runs).unknown


def test_the_text_has_one_line(agilus, library):
    text = prediction_text(predicted_in_full(agilus))
    assert sum("loses" in line for line in text.splitlines()) == 1
    assert "glass" in text
    last = data(viscous(agilus.viscous_runs))["states"][-1]["by_source"]
    lost = [one["relaxation"]["pressure_rise_loss_percent"] for one in last]
    assert f"loses {min(lost):.1f} to {max(lost):.1f} % from 1 s to 600 s" in text
    plain = prediction_text(predicted_in_full(evaluate("paper-dome", model="atlas", library=library)))
    assert "not known: no relaxation data for TangoPlus" in plain


def test_the_membrane_model_does_not_pay_for_the_atlas():
    code = (
        "import sys; from pneutouch.evaluation import evaluate; from pneutouch.evaluation.result import predicted_in_full; "
        "print(predicted_in_full(evaluate('agilus-dome', model='membrane')).viscous.unknown is not None, 'scipy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "False"]


def test_an_aged_sensor_is_the_fresh_one_with_the_shifted_modulus(library):
    material = resin(library, "TangoPlus")
    ratio = ageing_ratio(material)
    fresh, old = (evaluate("paper-dome", model="atlas", library=library, aged=aged) for aged in (False, True))
    assert old.sensor == fresh.sensor.replace(shear_modulus=ratio * fresh.sensor.wall.shear_modulus)
    # Everything of a neo-Hookean dome without gas scales with its modulus: so does the limit point.
    assert old.prediction.limits.limit_point == pytest.approx(ratio * fresh.prediction.limits.limit_point, rel=1e-9)
    new = set(old.prediction.assumptions) - set(fresh.prediction.assumptions)
    assert len(new) == 1
    said = new.pop()
    for word in ("aged one year", "27.6 to 29.5", "1.083", "Gent", "Shore A 80", "skin", "relaxed modulus"):
        assert word in said
    document = data(predicted_in_full(old))
    assert document["aged"]["modulus_ratio"] == pytest.approx(ratio, rel=1e-5)
    assert "aged" not in data(predicted_in_full(fresh))
    assert "aged one year: modulus times 1.083" in prediction_text(predicted_in_full(old))


def test_ageing_of_a_resin_that_is_not_known_is_refused_with_the_designs_name(library, command):
    with pytest.raises(
        InputError, match=r'agilus-dome.*membrane\.material = "Agilus30": aged: the hardness of Agilus30'
    ):
        evaluate("agilus-dome", model="atlas", library=library, aged=True)
    refused = command("predict", str(ROOT / "designs" / "agilus-dome.toml"), "--aged", "--model", "membrane")
    assert refused.returncode == 2 and "after a year is not known" in refused.stderr and refused.stdout == ""


def test_the_flag_reaches_the_prediction(command):
    done = command("predict", "paper-dome", "--aged", "--model", "membrane", "--json")
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert found["aged"]["modulus_ratio"] == pytest.approx(1.083, abs=1e-3)
    assert any(line.startswith("aged one year") for line in found["assumptions"])


@pytest.mark.slow
def test_the_sheets_section_has_the_figures_of_the_prediction(agilus):
    sheet = sheet_data(agilus, "")
    section = relaxation.viscous_section(sheet)
    (table,), (notes,) = found(section, SheetTable), found(section, Items)
    rows = iter(table.rows)
    for state in data(viscous(agilus.viscous_runs))["states"]:
        for one in state["by_source"]:
            row, held = next(rows), one["relaxation"]
            assert float(row[0]) == pytest.approx(state["driving_pressure_kPa"])
            assert float(row[2]) == pytest.approx(held["force_loss_percent"], abs=0.051)
            assert float(row[3]) == pytest.approx(held["pressure_rise_loss_percent"], abs=0.051)
            assert [float(x) for x in row[5:]] == pytest.approx(
                [t["width_percent"] for t in one["hysteresis"]], abs=0.051
            )
    assert next(rows, None) is None
    assert any("dogbone" in note for note in notes.lines) and any("1904.11888" in note for note in notes.lines)
    assert len(found(section, Plot)) == 2 and section == relaxation.viscous_section(sheet)
    assert len(relaxation.loop_panel(sheet).lines) == len(relaxation.held_panel(sheet).lines)


@pytest.mark.slow
def test_a_run_that_stops_is_told_in_the_section_and_not_drawn(agilus):
    sensor = agilus.sensor.replace(gauge_limit=0.03)
    runs = viscous_runs(agilus.prediction, agilus.scene.membrane_material, sensor)
    sheet = replace(sheet_data(agilus, ""), viscous=viscous(runs), viscous_runs=runs)
    section = relaxation.viscous_section(sheet)
    (table,), (notes,) = found(section, SheetTable), found(section, Items)
    assert any("gauge range" in note for note in notes.lines)
    assert any("–" in row for row in table.rows)
    whole = [loop for loop in list(runs.loops.values())[-1][-1] if loop.force_out.size > 1]
    assert len(relaxation.loop_panel(sheet).lines) == 2 * len(whole)


@pytest.mark.slow
def test_the_line_on_ageing(library):
    tango = evaluate("paper-dome", model="atlas", library=library)
    sheet = sheet_data(tango, "")
    line = relaxation.ageing_line(sheet)
    assert "27.6 to 29.5" in line and "+8.3%" in line and "14.76 %, sign not given" in line
    unknown = ageing_data(tango.prediction, resin(library, "Agilus30"), tango.sensor)
    assert relaxation.ageing_line(replace(sheet, ageing=unknown)).endswith("is not known.")


@pytest.mark.parametrize("table", [agilus_table, wall_table, pytest.param(friction_table, marks=pytest.mark.slow)])
def test_the_page_has_the_tables_of_today(table):
    assert "\n".join(table(Library((ROOT,)))) in (ROOT / "docs" / "background" / "viscous.md").read_text(
        encoding="utf-8"
    )


@pytest.mark.slow
def test_page_and_pdf_have_the_section(built, agilus):
    for name, word in (("agilus-dome", "contact is lost"), ("paper-dome", "no relaxation data for TangoPlus")):
        html = (built(name) / "datasheet.html").read_text(encoding="utf-8")
        pages = [page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(built(name) / "datasheet.pdf")]
        for text in (html, " ".join("\n".join(pages).split())):
            assert "Relaxation and hysteresis" in text and word in text and "Ageing:" in text
