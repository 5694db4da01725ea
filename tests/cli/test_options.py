"""The options of a command are declared once: flags, keywords of the Python function and studio follow from them."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Annotated

import pytest
import typer
from hypothesis import given as drawn
from hypothesis import strategies as st
from typer.testing import CliRunner

import pneutouch as pt
from pneutouch.cli.app import app
from pneutouch.cli.declared import given, with_options
from pneutouch.errors import InputError
from pneutouch.spec.fields import declarations
from pneutouch.spec.options import (
    CalibrationOptions,
    FitOptions,
    Options,
    PlanOptions,
    ScanOptions,
    SimulationOptions,
    flag_of,
    option,
    option_words,
    options_of,
)

COMMANDS = {
    "plan": (PlanOptions, pt.plan),
    "simulate": (SimulationOptions, pt.simulate),
    "scan": (ScanOptions, pt.scan),
    "calibrate": (CalibrationOptions, pt.calibrate),
    "fit-material": (FitOptions, pt.fit_material),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_flags_and_keywords_are_those_of_the_declared_options(command):
    model, function = COMMANDS[command]
    keywords = inspect.signature(function).parameters
    shown = CliRunner().invoke(app, [command, "--help"]).stdout
    for field in declarations(model):
        assert f"--{flag_of(model, field.key).replace('_', '-')} " in shown.replace("\n", " ")
        stated = keywords[field.key].default
        if model.model_fields[field.key].is_required():
            assert stated is inspect.Parameter.empty
        else:
            assert (list(stated) if isinstance(stated, tuple) else stated) == field.default


class _Shown(Options):
    depths_mm: list[float] = option([1.0], "Depths.", unit="mm", low=0, high=5)
    loud: bool = option(True, "Say nothing.", flag="quiet")


def test_an_option_is_added_in_one_place():
    """A flag with unit, bounds and default, checked and named in its errors, from the record alone."""
    shown, small = [], typer.Typer()

    @small.command()
    @with_options(_Shown)
    def show(what: Annotated[str, typer.Argument()], **options) -> None:
        shown.append((what, given(_Shown, options)))

    assert CliRunner().invoke(small, ["it", "--depths", "2,3", "--depths", "4"]).exit_code == 0
    assert CliRunner().invoke(small, ["it"]).exit_code == 0
    assert [options.depths_mm for _, options in shown] == [[2.0, 3.0, 4.0], [1.0]]
    refused = CliRunner().invoke(small, ["it", "--depths", "2,a"]).exception
    assert isinstance(refused, InputError) and refused.key == "depths_mm"


PRESSURES = st.lists(st.floats(0, 1000).map(lambda value: float(f"{value:.12g}")), max_size=4, unique=True)


@drawn(fit=st.lists(st.sampled_from(["wall", "offset"]), min_size=1, unique=True), held=PRESSURES, priors=st.booleans())
def test_the_words_of_options_give_these_options(fit, held, priors):
    options = options_of(CalibrationOptions, {"fit": fit, "hold_out_kPa": held, "priors": priors})
    found, small = [], typer.Typer()

    @small.command()
    @with_options(CalibrationOptions)
    def show(**words) -> None:
        found.append(given(CalibrationOptions, words))

    words = [word for name, text in option_words(options) for word in (f"--{name.replace('_', '-')}", text) if word]
    assert CliRunner().invoke(small, words).exit_code == 0
    assert found == [options]


@pytest.mark.parametrize(
    ("words", "key"),
    [
        (["simulate", "paper-dome", "--kinds", "steps,step"], "--kinds"),
        (["simulate", "paper-dome", "--ages", "0,40000"], "--ages"),
        (["simulate", "paper-dome", "--seed", "-1"], "--seed"),
        (["fit-material", "x.csv", "--name", "A", "--bonded"], "--bonded"),
        (["fit-material", "x.csv", "--name", "A", "--shore-a", "20,200"], "--shore-a"),
        (["calibrate", ".", "--hold-out", "5,5"], "--hold-out"),
    ],
)
def test_an_error_names_the_flag_as_it_is_typed(words, key):
    refused = CliRunner().invoke(app, words)
    assert refused.exit_code == 2 and refused.stderr.splitlines()[-1].startswith(f"error: {key}")


@pytest.mark.slow
@pytest.mark.parametrize("given_as", ["none.csv", Path("none.csv"), ["none.csv"], (Path("none.csv"),)])
def test_one_file_is_a_list_of_one(given_as):
    with pytest.raises(InputError) as caught:
        pt.scan("texture-specimen", "paper-dome", data=given_as)
    assert caught.value.file is not None and str(caught.value.file).endswith("none.csv")


@pytest.mark.parametrize("reading", [0.0, 100.0])
def test_the_ends_of_the_hardness_scale_are_no_readings(reading):
    """At 100 there is no modulus."""
    with pytest.raises(InputError) as caught:
        options_of(FitOptions, {"name": "A", "shore_a": [20.0, reading]})
    assert caught.value.key == "shore_a[1]"
