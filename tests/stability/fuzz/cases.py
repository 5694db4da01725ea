"""The cases: for every command its valid lines, for every kind of file a valid one and the command that reads it."""

from __future__ import annotations

import io
import random
import shutil
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tests.stability.fuzz.mutate import damaged_bytes, damaged_csv, damaged_toml, damaged_words

LINES: dict[str, tuple[str, ...]] = {
    "predict": (
        "paper-dome --model membrane",
        "graded-dome --model atlas --json",
        "paper-dome --model membrane --set membrane.wall_thickness_mm=1.2",
        "paper-dome --model membrane --for sensitivity=2.1 --for force_range=31",
    ),
    "list": ("", "materials --json", "examples", "gauges"),
    "new": ("mine", "mine --from fingertip-dome", "--from campaign", "mine --out there"),
    "build": (
        "paper-dome --model membrane",
        "texture-specimen",
        "built.3mf --out again",
        "paper-dome --voxels --voxel-mode High",
    ),
    "check": ("paper-dome", "texture-specimen --json", "paper-dome --deep"),
    "select": (
        "--sensitivity 1.9 --at 12 --force-range 15",
        "target.toml --write mine --pick 2",
        "--sensitivity 2 --inner-radius 9.25 --wall 1.5 --material TangoPlus",
        "--sensitivity 2 --at 12 --shape disc,cap --material TangoPlus --prefer low --max-height 6",
    ),
    "sweep": (
        "sweep.toml --workers 1",
        "--design paper-dome --over membrane.wall_thickness_mm=1:2:3 --model membrane --workers 1 --out a.nc",
    ),
    "tray": ("tray.toml", "paper-dome --over membrane.material=TangoPlus,FLX9940 --copies 2"),
    "coupons": ("", "--results results.toml", "--profile j735 --material Agilus30 --only puck --copies puck=2"),
    "fit-material": (
        "tension.csv --name mine --like DragonSkin20",
        "tension.csv --name mine --density 1.07 --shore-a 19,20 --stretch-to 2 --json",
        "press.csv --name mine --like DragonSkin20 --puck 20x10 --bonded",
    ),
    "plan": ("paper-dome", "paper-dome --rig rig.toml --resins TangoPlus,FLX9940 --json"),
    "simulate": (
        "paper-dome --pressures 0,22 --kinds steps --runs 1 --rest 2",
        "paper-dome --resins all --ages 0,7 --model atlas",
        "campaign --rest 2 --rate 20 --model atlas",
    ),
    "characterize": ("campaign", "campaign --json --target target.toml", "campaign/runs/run.csv --design paper-dome"),
    "calibrate": ("campaign --sensor TangoPlus-1 --hold-out 22 --save mine", "campaign --fit modulus,wall --json"),
    "table": ("paper-dome --set membrane.shape=cap", "paper-dome --set membrane.shape=cap --check", "paper-dome"),
    "compare": ("paper-dome soft-pad --model membrane", "paper-dome built --model membrane --json"),
    "scan": (
        "texture-specimen --design paper-dome",
        "texture-specimen --design paper-dome --data signal.csv --pressures 0,22",
    ),
    "show": ("built.3mf", "stack --json"),
    "schema": ("--json", "design", "prediction"),
    "export-reader": (
        "paper-dome --model membrane",
        "paper-dome --model membrane --set pneumatics.gauge=honeywell-abp2-5psi --json",
        "paper-dome --simulator urdf",
    ),
    "discriminate": ("paper-dome --pressures 0,12 --balls 8 --json",),
    "respond": ("paper-dome --model membrane --step 2N", "paper-dome --model membrane --sine 5Hz --peak 2N --json"),
}
"""Valid command lines; what they name lies in the folder of a case."""

MODELLED = {"predict", "compare"}
"""Commands that compute here: the closed form takes a millisecond."""

RESULTS = """lab = "our lab"
date = 2026-11-21
[puck.TangoPlus]
shore_a = [27, 28, 29]
mass_g = [1.0, 1.1]
diameter_mm = [20.0, 20.1]
thickness_mm = [6.0, 6.1]
[dumbbell.TangoPlus]
hold_s = 60
[[dumbbell.TangoPlus.specimen]]
width_mm = [5.0, 5.1]
thickness_mm = [2.0, 2.1]
extension_mm = [1.0, 2.0, 3.0]
force_N = [0.2, 0.4, 0.55]
[gauge.objet260-connex.TangoPlus]
x = [{nominal_mm = 10, measured_mm = [10.05, 10.04]}]
wall = [{nominal_mm = 0.5, came_out = false}]
[leak-cap.paper-dome]
start_kPa = [20.0, 20.0]
end_kPa = [19.5, 19.6]
pressure_kPa = [10.0, 20.0]
[[mixing."TangoPlus+VeroClear"]]
fraction = 0.1
shore_a = [33, 34, 35]
"""
RIG = '[rig]\nname = "ours"\nforce_range_N = 50.0\nforce_resolution_N = 0.01\npressure_range_kPa = 100\ntravel_mm = 50\nrate_Hz = 1000\n'


@dataclass(frozen=True)
class Case:
    """A folder made ready, and the words to run in it."""

    kind: str
    words: list[str]


Maker = Callable[[random.Random, Path, Path], list[str]]
"""Makes the folder of a case ready (generator, folder of valid files, folder of the case); returns its words."""


def make(rng: random.Random, base: Path, folder: Path, options: dict[str, list[str]]) -> Case:
    """One case: a damaged command line, or a sound one with a damaged file."""
    if rng.random() < 0.4:
        command = rng.choice(sorted(LINES))
        line = rng.choice(LINES[command])
        provide(base, folder, line)
        words = damaged_words([command, *line.split()], options[command], rng)
        return Case(command, words)
    kind = rng.choice(sorted(FILES))
    return Case(kind, FILES[kind](rng, base, folder))


def provide(base: Path, folder: Path, line: str) -> None:
    """Put the valid files that a command line names into the folder of a case."""
    for word in line.replace("/", " ").split():
        if (base / word).is_dir():
            shutil.copytree(base / word, folder / word, dirs_exist_ok=True)
        elif (base / word).is_file():
            shutil.copy(base / word, folder / word)


def _toml(source: str, target: str, line: str) -> Maker:
    def maker(rng: random.Random, base: Path, folder: Path) -> list[str]:
        path = folder / target
        path.parent.mkdir(parents=True, exist_ok=True)
        text = (base / source if (base / source).is_file() else ROOT / source).read_text(encoding="utf-8")
        path.write_bytes(damaged_toml(text, rng))
        return line.split()

    return maker


def _run(rng: random.Random, base: Path, folder: Path) -> list[str]:
    """A campaign with a damaged file of a run, or with a damaged campaign file."""
    provide(base, folder, "campaign")
    if rng.random() < 0.5:
        path = rng.choice(sorted((folder / "campaign").rglob("*.csv")))
        path.write_bytes(damaged_csv(path.read_text(), rng))
    else:
        path = folder / "campaign/campaign.toml"
        path.write_bytes(damaged_toml(path.read_text(), rng))
    return rng.choice((["characterize", "campaign", "--json"], ["calibrate", "campaign"], ["characterize", "campaign"]))


def _signal(rng: random.Random, base: Path, folder: Path) -> list[str]:
    (folder / "signal.csv").write_bytes(damaged_csv((base / "signal.csv").read_text(), rng))
    return ["scan", "texture-specimen", "--design", "paper-dome", "--data", "signal.csv"]


def _tension(rng: random.Random, base: Path, folder: Path) -> list[str]:
    (folder / "tension.csv").write_bytes(damaged_csv((base / "tension.csv").read_text(), rng))
    return ["fit-material", "tension.csv", "--name", "mine", "--like", "DragonSkin20"]


def _threemf(rng: random.Random, base: Path, folder: Path) -> list[str]:
    """A 3MF damaged as a whole, or whose recipe and model are damaged inside of a sound archive."""
    content = (base / "built.3mf").read_bytes()
    if rng.random() < 0.4:
        content = damaged_bytes(content, rng)
    else:
        buffer = io.BytesIO()
        with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(buffer, "w") as new:
            chosen = rng.choice(old.namelist())
            for name in old.namelist():
                part = old.read(name)
                new.writestr(name, _near_end(part, rng) if name == chosen else part)
        content = buffer.getvalue()
    (folder / "built.3mf").write_bytes(content)
    return rng.choice((["show", "built.3mf", "--json"], ["show", "built.3mf"], ["build", "built.3mf"]))


def _near_end(part: bytes, rng: random.Random) -> bytes:
    """A part damaged in its first kilobytes, where the metadata stands, or anywhere."""
    if rng.random() < 0.7:
        return damaged_bytes(part[:20_000], rng) + part[20_000:]
    return damaged_bytes(part, rng)


def _stack(rng: random.Random, base: Path, folder: Path) -> list[str]:
    provide(base, folder, "stack")
    path = rng.choice([next((folder / "stack").glob("*.json")), *sorted((folder / "stack").glob("*.png"))[:3]])
    path.write_bytes(damaged_bytes(path.read_bytes(), rng))
    return ["show", "stack"]


def _sweep_rest(rng: random.Random, base: Path, folder: Path) -> list[str]:
    """A sweep that was stopped, or is done, whose journal or dataset is damaged."""
    if rng.random() < 0.5:
        (folder / "a.nc").write_bytes(damaged_bytes((base / "a.nc").read_bytes(), rng))
    else:
        (folder / "a.nc.parts").mkdir()
        (folder / "a.nc.parts/journal").write_bytes(damaged_bytes((base / "journal").read_bytes(), rng))
    return ["sweep", *LINES["sweep"][1].split()]


def _built(rng: random.Random, base: Path, folder: Path) -> list[str]:
    """A folder that `compare` and `build` read again, with damage to its data."""
    provide(base, folder, "built")
    path = folder / "built" / rng.choice(("manifest.json", "prediction.json"))
    path.write_bytes(damaged_bytes(path.read_bytes(), rng))
    (folder / "outputs").mkdir()
    (folder / "built").rename(folder / "outputs/paper-dome") if rng.random() < 0.3 else None
    there = "outputs/paper-dome" if (folder / "outputs/paper-dome").is_dir() else "built"
    return rng.choice(
        (["compare", "paper-dome", there, "--model", "membrane"], ["build", "paper-dome", "--model", "membrane"])
    )


_PREDICT = "predict paper-dome --model membrane"
FILES: dict[str, Maker] = {
    "design": _toml("designs/fingertip-dome.toml", "mine.toml", "predict mine.toml --model membrane --json"),
    "graded design": _toml("designs/graded-dome.toml", "mine.toml", "predict mine.toml --model membrane"),
    "whole design": _toml("mine.toml", "mine.toml", "predict mine.toml --model membrane"),
    "checked design": _toml("designs/long-tube.toml", "mine.toml", "check mine.toml"),
    "material": _toml("printprofiles/materials/TangoPlus.toml", "printprofiles/materials/TangoPlus.toml", _PREDICT),
    "mix": _toml(
        "printprofiles/mixing/TangoPlus+VeroClear.toml",
        "printprofiles/mixing/TangoPlus+VeroClear.toml",
        "predict graded-dome --model membrane",
    ),
    "printer": _toml("printprofiles/objet260-connex.toml", "printprofiles/objet260-connex.toml", _PREDICT),
    "calibration": _toml(
        "mine-calibration.toml", "calibrations/mine.toml", "predict paper-dome --model membrane --calibration mine"
    ),
    "specimen": _toml("designs/specimens/texture-specimen.toml", "mine.toml", "check mine.toml"),
    "target": _toml("docs/examples/fingertip.toml", "target.toml", "select target.toml"),
    "sweep": _toml("docs/examples/wall-and-resin.toml", "sweep.toml", "sweep sweep.toml --workers 1"),
    "tray": _toml("docs/examples/seven-resins.toml", "tray.toml", "tray tray.toml"),
    "rig": _toml("rig.toml", "rig.toml", "plan paper-dome --rig rig.toml"),
    "results": _toml("results.toml", "results.toml", "coupons --results results.toml"),
    "campaign": _run,
    "signal": _signal,
    "tension": _tension,
    "3MF": _threemf,
    "voxel stack": _stack,
    "stopped sweep": _sweep_rest,
    "output folder": _built,
}
