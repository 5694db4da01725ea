"""A printer profile of the lab's own is checked like any other input."""

from __future__ import annotations

import contextlib
import re

import pytest
from typer.testing import CliRunner

from pneutouch.catalogue import Library, load_scene
from pneutouch.cli.app import app
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from tests.conftest import ROOT

SHIPPED = (ROOT / "printprofiles/abs-filament.toml").read_text()


def own(folder, text):
    (folder / "printprofiles").mkdir()
    path = folder / "printprofiles/abs-filament.toml"
    path.write_text(re.sub(r"(\[hole_undersize_mm\]\n).*?(?=source)", rf"\g<1>{text}\n", SHIPPED, flags=re.DOTALL))
    return Library((folder, ROOT))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("value = -7.5", "value = -7.5"),
        ("value = 1.2", "value = 1.2"),
        ("low = -3.0\nhigh = 3.0", "low = -3"),
        ("value = 0.2\nlow = 0.1\nhigh = 2.0", "high = 2"),
    ],
)
def test_a_hole_undersize_that_no_printer_has_is_refused(tmp_path, text, said):
    with pytest.raises(InputError) as error:
        own(tmp_path, text).load("printers", "abs-filament")
    assert str(error.value) == (
        f"{tmp_path}/printprofiles/abs-filament.toml: hole_undersize_mm: {said}: must be from -0.5 to 1 mm"
    )


def test_it_is_an_input_error_on_the_command_line(tmp_path, monkeypatch):
    own(tmp_path, "value = -7.5")
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["tray", "paper-dome", "--profile", "abs-filament"])
    assert result.exit_code == 2, result.output
    assert "hole_undersize_mm: value = -7.5: must be from -0.5 to 1 mm" in result.stderr


@pytest.mark.parametrize("text", ["value = -0.5", "value = 1.0", "low = -0.5\nhigh = 1.0"])
def test_designs_draw_or_say_why_not_at_the_bounds(tmp_path, text):
    library = own(tmp_path, text)
    for design in sorted((ROOT / "designs").glob("*.toml")):
        # An InputError says why not; anything else is our fault.
        with contextlib.suppress(InputError):
            assemble(
                load_scene(
                    design.stem, {"print.connector_profile": "abs-filament", "connector.material": "ABS"}, library
                )
            )
