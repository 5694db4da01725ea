"""What a lab has limits what a selection takes: resins, printers, gauges and ports."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.workflows.select.base import read_shelf
from pneutouch.workflows.select.processes import offers, select, select_processes
from pneutouch.workflows.select.search import relief_of

FREE = {"target": {"sensitivity_kPa_per_N": 1.9, "driving_pressure_kPa": 12.0}, "given": {"inner_radius_mm": 9.25}}


def chosen(library, **tables):
    return select(validate(Target, {**FREE, **tables}, "target"), "target", library)


def test_resins_that_are_not_on_the_shelf_are_not_taken(library):
    run = chosen(library, have={"materials": ["FLX9940", "FLX9960"]})
    assert {design.resin.name for design in run.answer.designs} == {"FLX9940", "FLX9960"}
    assert run.left_out["TangoPlus"] == "it is not on the shelf"


def test_an_open_gauge_is_one_of_the_shelf(library):
    run = chosen(library, have={"gauges": ["nxp-mpx5100gp"]}, setting={"gauge": "any"})
    assert run.answer.designs and [trial.gauge for trial in run.gauges] == ["nxp-mpx5100gp"]


def test_only_printers_of_the_shelf_are_offered(library):
    shelf = {"printers": ["objet260-connex", "silicone-casting"]}
    run = chosen(library, have=shelf)
    assert offers(run.base, run.target, library) == []
    assert offers(run.base, run.target, library, others=True) == ["casting"]
    free = chosen(library)
    assert offers(free.base, free.target, library) == ["j55", "j735"]


def test_a_process_whose_printer_is_not_on_the_shelf_is_left_out_for_that(library):
    shelf, setting = {"printers": ["j735"]}, {"processes": ["casting"]}
    run = select_processes(validate(Target, {**FREE, "have": shelf, "setting": setting}, "target"), "target", library)
    assert {"silicone-casting", "j735"} <= set(run.left_out["casting"].split())
    resins = {"materials": ["DragonSkin20"]}
    with pytest.raises(InputError) as caught:
        chosen(library, have={"printers": ["objet260-connex"]}, given={**FREE["given"], **resins})
    # No option is proposed that the shelf refuses.
    assert "`" not in caught.value.remedy


def test_a_change_that_is_named_takes_a_port_of_the_shelf(library):
    impossible = {**FREE["target"], "sensitivity_kPa_per_N": 2.6}
    run = chosen(library, target=impossible, have={"ports": ["thread-M5"]})
    changes = relief_of(run, run.target, library).changes
    ports = [change.value for change in changes if change.field == "setting.assignments"]
    assert not run.answer.designs and set(ports) <= {"connector.port=thread-M5"}


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"have": {"printers": ["j735"]}}, r"objet260-connex is not on the shelf.*j735; give one of them by `profile`"),
        ({"have": {"materials": ["FLX99"]}}, r"have\.materials = \"FLX99\": no such name"),
        ({"have": {"materials": ["FLX9940"]}, "given": {"materials": ["TangoPlus"]}}, "names TangoPlus, which"),
        ({"have": {"materials": ["ABS"]}}, r"have\.materials: none is an elastomer"),
        ({"have": {"materials": ["ABS", "DragonSkin20"]}}, "runs none of DragonSkin20; .*`profile` silicone-casting"),
        ({"have": {"resins": ["FLX9940"]}}, r"have\.resins: unknown key"),
    ],
)
def test_a_shelf_that_cannot_be_meant_is_refused(tables, said, library):
    with pytest.raises(InputError, match=said):
        chosen(library, **tables)


def test_a_file_of_the_shelf_is_named_with_its_key(tmp_path):
    path = tmp_path / "shelf.toml"
    path.write_text('gauges = ["MPX"]\n')
    with pytest.raises(InputError, match=rf'{path}: gauges = "MPX": no such name among the gauges'):
        read_shelf(path)
    path.write_text('gauges = ["nxp-mpx5100gp"]\nprinters = ["j735"]\n')
    shelf = read_shelf(path)
    assert (shelf.gauges, shelf.printers, shelf.materials) == (["nxp-mpx5100gp"], ["j735"], None)
