"""``pneutouch characterize`` and ``calibrate`` on files of other programs, as a user meets them."""

from __future__ import annotations

import json
import re
import shutil
import tomllib

import pandas as pd
import pytest
from typer.testing import CliRunner

from pneutouch.bench.reading import PLATE
from pneutouch.bench.source import campaign_lines, identify
from pneutouch.cli import calibrate, characterize, plan
from pneutouch.cli.app import app
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign, ColumnMap
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.read import validate
from pneutouch.tables.unit_words import UNITS
from pneutouch.workflows.characterize.load import parse_columns, with_reading
from pneutouch.workflows.simulate import simulate
from tests.conftest import ROOT
from tests.refusals import refused
from tests.tables.instruments import INSTRUMENTS, logger, zwick

assert calibrate and characterize and plan

PAGE = (ROOT / "docs" / "howto" / "measuring.md").read_text(encoding="utf-8")
ASKED = SimulationOptions(specimens=1, driving_pressures_kPa=[0.0], runs=1, kinds=["steps"], model="atlas", rest_s=5.0)


def run(*arguments):
    return CliRunner().invoke(app, [str(word) for word in arguments])


@pytest.fixture(scope="module")
def recording(tmp_path_factory, library):
    """The columns of one simulated run: s, mm, N, kPa."""
    folder = simulate("paper-dome", tmp_path_factory.mktemp("made"), None, ASKED, library)
    (file,) = (folder / "runs").iterdir()
    frame = pd.read_csv(file, comment="#")
    return [frame[name].to_numpy() for name in ("time_s", "position_mm", "force_N", "pressure_kPa")]


def figures(document):
    """What is printed of each run, by its file."""
    return {
        entry["file"]: {key: f"{value:.4g}" for key, value in entry["figures"].items()} for entry in document["runs"]
    }


@pytest.mark.slow
def test_ten_instruments_give_the_printed_figures_of_the_plain_file(tmp_path, recording):
    """One campaign of the same run in every manner; the plain file first."""
    pd.DataFrame(dict(zip(("time_s", "position_mm", "force_N", "pressure_kPa"), recording, strict=True))).to_csv(
        tmp_path / "plain.csv", index=False
    )
    files = ["plain.csv", *(make(tmp_path, *recording).name for make in INSTRUMENTS)]
    runs = "".join(
        f'[[runs]]\nfile = "{name}"\nsensor = "S{k}"\nresin = "TangoPlus"\n\n' for k, name in enumerate(files)
    )
    (tmp_path / "campaign.toml").write_text(f'design = "paper-dome"\n\n{runs}')
    result = run(
        "characterize", tmp_path, "--model", "atlas", "--evidence", "none", "--json", "--out", tmp_path / "out"
    )
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    values = figures(document)
    assert len(files) == 12 and set(values) == set(files)
    assert all(values[name] == values["plain.csv"] for name in files)
    assert sorted(name for entry in document["read_as"] for name in entry["files"]) == sorted(files[1:])
    assert result.stderr.count("note: ") == len(document["read_as"])


@pytest.mark.slow
def test_what_is_printed_is_what_the_page_shows(tmp_path, recording):
    path = zwick(tmp_path, *recording)
    result = run(
        "characterize", path, "--design", "paper-dome", "--model", "atlas", "--evidence", "none", "--out", tmp_path
    )
    assert result.exit_code == 0, result.output
    (shown,) = re.findall(r"```text\n(note: zwick.*?)```", PAGE, re.DOTALL)
    assert shown.strip() in result.stderr
    lines = result.stderr[
        result.stderr.index("[format]") : result.stderr.index("next:") if "next:" in result.stderr else None
    ]
    (tmp_path / "campaign.toml").write_text(
        f'design = "paper-dome"\n{lines}\n[[runs]]\nfile = "zwick.txt"\nsensor = "A"\nresin = "TangoPlus"\n'
    )
    again = run("characterize", tmp_path, "--model", "atlas", "--evidence", "none", "--out", tmp_path)
    assert again.exit_code == 0 and "note: " not in again.stderr
    assert "next: pneutouch calibrate" in again.stderr


@pytest.mark.slow
def test_what_is_printed_of_mixed_files_belongs_to_their_runs(tmp_path, recording):
    """Pasted below each entry it is what was read, and nothing is printed again; a plain file between needs nothing."""
    plain = dict(zip(("time_s", "position_mm", "force_N", "pressure_kPa"), recording, strict=True))
    pd.DataFrame(plain).to_csv(tmp_path / "plain.csv", index=False)
    names = [zwick(tmp_path, *recording).name, "plain.csv", logger(tmp_path, *recording).name]
    entries = [f'[[runs]]\nfile = "{name}"\nsensor = "{name[0]}"\nresin = "TangoPlus"\n' for name in names]
    (tmp_path / "campaign.toml").write_text('design = "paper-dome"\n' + "".join(entries))
    words = ("characterize", tmp_path, "--model", "atlas", "--evidence", "none", "--json", "--out", tmp_path / "out")
    first = run(*words)
    assert first.exit_code == 0, first.output
    assert [entry["whole_campaign"] for entry in json.loads(first.stdout)["read_as"]] == [False, False]
    noted = re.findall(
        r"note: (\S+): read as follows; .* below the \[\[runs\]\] entry .*\n((?:(?!note).*\n?)*)", first.stderr
    )
    assert [name for name, _ in noted] == [names[0], names[2]]
    pasted = [entries[0] + noted[0][1], entries[1], entries[2] + noted[1][1]]
    (tmp_path / "campaign.toml").write_text('design = "paper-dome"\n' + "\n".join(pasted))
    again = run(*words)
    assert again.exit_code == 0 and "note: " not in again.stderr, again.output
    assert figures(json.loads(again.stdout)) == figures(json.loads(first.stdout))
    (entry,) = [one for one in tomllib.loads("\n".join(pasted))["runs"] if one["file"] == names[0]]
    assert entry["columns"]["pressure"] == {"name": "Innendruck", "unit": "mbar"}


def test_a_run_states_its_own_columns_over_those_of_its_campaign():
    own = {"columns": {"force": {"name": "F2", "unit": "kN"}}, "format": {"decimal": ","}}
    run = {"file": "a.csv", "sensor": "A", "resin": "TangoPlus"}
    content = {
        "columns": {"force": {"name": "F"}, "time": {"name": "t"}},
        "format": {"delimiter": ";"},
        "runs": [{**run, **own}, {**run, "file": "b.csv", "run": 2}],
    }
    campaign = Campaign.model_validate(content)
    columns, written = campaign.reading(campaign.runs[0])
    assert (columns.force.name, columns.force.unit, columns.time.name) == ("F2", "kN", "t")
    assert columns.model_fields_set == {"force", "time"} and (written.delimiter, written.decimal) == (";", ",")
    plain, unwritten = campaign.reading(campaign.runs[1])
    assert plain.force.name == "F" and unwritten.decimal is None
    # The command line comes before both.
    laid = with_reading(campaign, {"columns": {"force": {"name": "Load"}}, "format": {"decimal": "."}})
    assert [laid.reading(one)[0].force.name for one in laid.runs] == ["Load", "Load"]
    assert [laid.reading(one)[1].decimal for one in laid.runs] == [".", "."]
    with pytest.raises(InputError, match=r"with the columns of a\.csv in the campaign: time") as caught:
        with_reading(campaign, {"columns": {"time": {"name": "F2"}}})
    assert caught.value.key == "columns"
    with pytest.raises(InputError, match=r"runs\[0\].columns with those of the campaign: time.name = \"t\""):
        validate(Campaign, {**content, "runs": [{**run, "columns": {"force": {"name": "t"}}}]}, "campaign.toml")


def test_an_error_names_the_option_and_the_lines_to_paste(tmp_path, recording):
    path = logger(tmp_path, *recording)
    path.write_text(path.read_text().replace("load_g", "load"))
    result = run("characterize", path, "--design", "paper-dome")
    assert result.exit_code == 2
    assert "give --columns" in result.stderr and 'force = { name = "load", unit = "?" }  # unit: N' in result.stderr
    options = ["--model", "atlas", "--evidence", "none", "--out", tmp_path, "--json"]
    given = run("characterize", path, "--design", "paper-dome", "--columns", "force=load:g", *options)
    assert given.exit_code == 0, given.output
    (entry,) = json.loads(given.stdout)["read_as"]
    assert entry["columns"]["force"] == {"name": "load", "unit": "gf"}


def twins(tmp_path, recording, unit):
    """A campaign of two files of one instrument, whose forces are named to be in ``unit``."""
    path = logger(tmp_path, *recording)
    path.write_text(path.read_text().replace("load_g", f"load_{unit}"))
    # The last row is left out: the same bytes would be no second run.
    (tmp_path / "other.log").write_text("\n".join(path.read_text().splitlines()[:-1]) + "\n")
    entries = [
        f'[[runs]]\nfile = "{name}"\nsensor = "A"\nresin = "TangoPlus"\nrun = {k + 1}\n'
        for k, name in enumerate((path.name, "other.log"))
    ]
    (tmp_path / "campaign.toml").write_text('design = "paper-dome"\n' + "".join(entries))
    return run("characterize", tmp_path, "--model", "atlas", "--evidence", "none", "--out", tmp_path / "out")


def test_what_is_wrong_in_several_files_is_printed_once(tmp_path, recording):
    result = twins(tmp_path, recording, "")
    assert result.exit_code == 2 and result.stderr.count("[columns]") == 1
    named = ", ".join(str(tmp_path / name) for name in ("logger.log", "other.log"))
    assert f"none of its files can be read\n{named}: column load_: " in result.stderr


def test_columns_that_an_error_rejects_are_not_to_be_kept(tmp_path, recording):
    assert "note: logger.log and 1 more: read as follows" in twins(tmp_path, recording, "g").stderr
    rejected = twins(tmp_path, recording, "N")
    assert rejected.exit_code == 3 and "set columns.force = {" in rejected.stderr
    assert "to keep it" not in rejected.stderr


def test_a_minus_turns_the_sign(tmp_path, recording):
    time, position, force, pressure = recording
    path = logger(tmp_path, time, position, -force, pressure)
    words = [
        "characterize",
        path,
        "--design",
        "paper-dome",
        "--model",
        "atlas",
        "--evidence",
        "none",
        "--out",
        tmp_path,
    ]
    refused = run(*words)
    assert refused.exit_code == 3 and "give --columns force=-load_g:gf" in refused.stderr
    assert run(*words, "--columns", "force=-load_g").exit_code == 0


def test_the_options_of_calibrate_are_those_of_characterize(tmp_path, recording):
    path = logger(tmp_path, *recording)
    path.write_text(path.read_text().replace("load_g", "load"))
    (tmp_path / "campaign.toml").write_text(
        'design = "paper-dome"\n[[runs]]\nfile = "logger.log"\nsensor = "A"\nresin = "TangoPlus"\n'
    )
    refused = run("calibrate", tmp_path)
    assert refused.exit_code == 2 and "no unit of the force" in refused.stderr
    done = run(
        "characterize",
        tmp_path,
        "--columns",
        "force=load:g",
        "--model",
        "atlas",
        "--evidence",
        "none",
        "--out",
        tmp_path,
    )
    assert "next: pneutouch calibrate" in done.stderr and "--columns force=load:g" in done.stderr


def test_columns_as_texts():
    columns = parse_columns(["time=Time, s,force=-Load (N):N", "pressure=p:mbar,position=Position(Crosshead:Position)"])
    assert columns == {
        "time": {"name": "Time, s", "unit": "", "sign": 1},
        "force": {"name": "Load (N)", "unit": "N", "sign": -1},
        "pressure": {"name": "p", "unit": "mbar", "sign": 1},
        "position": {"name": "Position(Crosshead:Position)", "unit": "", "sign": 1},
    }
    for text in ("Load", "force=", "force=-", "strain=e"):
        with refused("columns"):
            parse_columns([text])


def test_options_come_before_the_campaign(tmp_path):
    campaign = Campaign.model_validate(
        tomllib.loads(
            '[format]\ndecimal = ","\nsheet = "A"\n[columns]\ntime = { name = "t", unit = "ms" }\n'
            'force = { name = "F", unit = "N" }\n[[runs]]\nfile = "a"\nsensor = "A"\nresin = "FLX9950"\n'
        )
    )
    laid = with_reading(campaign, {"columns": {"force": {"name": "G", "unit": "lbf"}}, "format": {"decimal": "."}})
    assert (laid.columns.time.name, laid.columns.force.unit) == ("t", "lbf")
    assert laid.columns.model_fields_set == {"time", "force"}
    assert (laid.format.decimal, laid.format.sheet) == (".", "A")
    with pytest.raises(InputError, match=r"force\.unit"):
        with_reading(campaign, {"columns": {"force": {"name": "G", "unit": "kPa"}}})
    with pytest.raises(InputError, match="decimal"):
        with_reading(campaign, {"format": {"decimal": ":"}})


def test_the_page_lists_every_unit():
    for channel, units in UNITS.items():
        (row,) = re.findall(rf"^\| {channel} \| ([^;|]*)", PAGE, re.MULTILINE)
        assert [unit.strip() for unit in row.split(",")] == list(units)


@pytest.mark.slow
def test_a_planned_campaign_takes_files_of_other_programs(tmp_path, recording):
    """Its file leaves the columns open, and takes the lines that were printed."""
    assert run("plan", "paper-dome", "--specimens", "1", "--out", tmp_path).exit_code == 0
    (folder,) = (path for path in tmp_path.iterdir() if path.is_dir())
    text = (folder / "campaign.toml").read_text()
    campaign = Campaign.model_validate(tomllib.loads(text))
    assert campaign.columns.model_fields_set == set() and campaign.format.model_fields_set == set()
    found = identify(zwick(tmp_path, *recording), campaign.columns, PLATE, campaign.format)
    pasted = Campaign.model_validate(tomllib.loads(f"{text}\n{campaign_lines(found.content)}\n"))
    assert pasted.columns.force.name == "Standardkraft" and pasted.format.decimal == ","


def test_a_shell_s_copy_of_a_file_is_read_the_same(tmp_path, recording):
    """The suffix of a text file does not matter."""
    path = zwick(tmp_path, *recording)
    other = shutil.copy(path, tmp_path / "run.TRA")
    assert identify(path, ColumnMap(), PLATE).columns == identify(tmp_path / other, ColumnMap(), PLATE).columns
