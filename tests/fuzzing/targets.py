"""What is fuzzed: every reader of bytes that others wrote, each as a function of a file."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.catalogue.cached_library import CachedLibrary
from pneutouch.errors import InputError, PneutouchError
from pneutouch.spec.read import read_toml, validate
from tests.fuzzing.parts import archive
from tests.fuzzing.place import ROOT


@dataclass(frozen=True)
class Target:
    """A reader. ``name`` is the file's; ``written`` makes the file's bytes of an input; ``allowed`` are its errors.

    ``library`` is the one that an extra needs.
    """

    name: str
    read: Callable[[Path], object]
    written: Callable[[bytes], bytes] = bytes
    allowed: tuple[type[Exception], ...] = (InputError,)
    library: str = ""


@cache
def library() -> Library:
    return CachedLibrary((ROOT,))


def _of_kind(kind: str) -> Callable[[Path], object]:
    def read(path: Path) -> object:
        from pneutouch.catalogue import KINDS

        return KINDS[kind].validate(read_toml(path), str(path))

    return read


def _design(path: Path) -> object:
    return load_scene(DesignSource.of(str(path), library()), {}, library())


def _specimen(path: Path) -> object:
    from pneutouch.workflows.specimen.load import load_specimen

    return load_specimen(str(path), {}, library())


def _target(path: Path) -> object:
    from pneutouch.spec.target import Target as TargetFile

    return validate(TargetFile, read_toml(path), str(path))


def _sweep(path: Path) -> object:
    from pneutouch.workflows.sweep.read import plan_of_file

    return plan_of_file(path)


def _tray(path: Path) -> object:
    from pneutouch.workflows.tray.order import order_of_file

    return order_of_file(path)


def _tasks(path: Path) -> object:
    from pneutouch.spec.tasks import read_tasks

    return read_tasks(path)


def _campaign(path: Path) -> object:
    from pneutouch.spec.campaign_file import campaign_of, design_of

    campaign, folder = campaign_of(path)
    return design_of(campaign, folder)


def _coupons(path: Path) -> object:
    from pneutouch.spec.coupon import read_results

    return read_results(path)


def _run(path: Path) -> object:
    from pneutouch.bench.reading import PLATE, read_blocks
    from pneutouch.bench.source import identify
    from pneutouch.spec.campaign import ColumnMap, FileFormat, Rig

    return read_blocks(identify(path, ColumnMap(), PLATE, FileFormat()), Rig())


def _threemf(path: Path) -> object:
    from pneutouch.export.threemf_read import read_threemf
    from pneutouch.output.recipe_read import read_recipe

    return read_recipe(read_threemf(path))


def _recipe(path: Path) -> object:
    """A recipe as the text that a 3MF holds, with the hash that belongs to it where it has one."""
    from pneutouch.export.threemf_read import Package
    from pneutouch.output.manifest import input_hash
    from pneutouch.output.recipe_read import read_recipe

    text = path.read_bytes().decode("utf-8", "replace")
    try:
        content = json.loads(text)
        stated = {"input-hash": input_hash(content["inputs"], content["version"])}
    except (ValueError, TypeError, KeyError, RecursionError):
        stated = {}
    return read_recipe(Package(path, (), stated, text, False, ()))


def _dataset(path: Path) -> object:
    from pneutouch.workflows.sweep.dataset import stored_dataset, stored_fingerprint

    stored_fingerprint(path)
    return stored_dataset(path)


def _journal(path: Path) -> object:
    from pneutouch.workflows.sweep.journal import Journal, _checksum

    lines = path.read_bytes().split(b"\n")
    path.write_bytes(b"".join(_checksum(line) + b" " + line + b"\n" for line in lines))
    return Journal(path, "ab").read()


def _slice(path: Path) -> object:
    from pneutouch.export.voxels.png import decode

    return decode(path.read_bytes(), str(path))


def _stack(path: Path) -> object:
    from pneutouch.export.voxels.read import read_stack

    return read_stack(path.parent)


def _leak(path: Path) -> object:
    from pneutouch.workflows.driving.leak import _of_campaign

    return _of_campaign(path, "paper-dome")


def _prediction(path: Path) -> object:
    """The prediction of an output folder, by one who makes its manifest agree with it."""
    from pneutouch.output.files import MANIFEST, digest
    from pneutouch.workflows.compare.predicted import of_build
    from tests.fuzzing.seeds import recipe

    inputs, version, stated = recipe()
    files = {path.name: {"sha256": digest(path.read_bytes())}}
    head = {"name": "a", "inputs": inputs, "versions": {"pneutouch": version}, "input_hash": stated}
    (path.parent / MANIFEST).write_text(json.dumps(head | {"files": files}))
    return of_build(path.parent).sensor({})


def _figures(path: Path) -> object:
    """The figures of a folder of results, likewise."""
    from pneutouch.output.files import MANIFEST, digest
    from pneutouch.workflows.compare.measured import measured_columns
    from tests.fuzzing.seeds import POINTS

    (path.parent / "points.csv").write_bytes(POINTS)
    files = {name: {"sha256": digest((path.parent / name).read_bytes())} for name in (path.name, "points.csv")}
    (path.parent / MANIFEST).write_text(json.dumps({"name": "a", "files": files}))
    return measured_columns(path.parent)


def _exported(path: Path) -> object:
    from pneutouch.studio.opening import open_file

    files = [{"name": path.name, "path": str(path)}]
    return open_file({"files": files, "bases": _bases()}, path.parent, lambda done, total, what: None)


@cache
def _bases() -> dict[str, str]:
    return {name: name for name in library().paths("designs")}


def _question(path: Path) -> object:
    """The body of a question, as the page sends it, to its answer by the atlas."""
    from pneutouch.studio.question import Question

    question = Question.of(_body(path))
    load_scene(question.source(_bases(), library()), {}, library())
    return _answers().quick(question)


@cache
def _answers() -> Any:
    from pneutouch.studio.answer import Answers

    return Answers(_bases(), library())


def _search(path: Path) -> object:
    from pneutouch.studio.question import Question
    from pneutouch.studio.target import target_of

    return target_of(Question.of(_body(path)), _bases())


def _body(path: Path) -> Any:
    from starlette.requests import Request

    from pneutouch.studio.body import json_body

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": path.read_bytes(), "more_body": False}

    request = Request({"type": "http", "method": "POST", "headers": []}, receive)
    return asyncio.run(json_body(request, "question"))


def _measured(path: Path) -> object:
    """What the page states of measured files: the arguments of a job."""
    from pneutouch.studio import measuring

    content = _body(path)
    if not isinstance(content, dict):
        raise InputError("no object")
    measuring._reading(content)
    for key in ("sensor", "save"):
        measuring._text(content, key)
    for key in ("fit", "paths"):
        measuring._texts(content, key)
    measuring._numbers(content, "hold_out_kPa")
    runs = content.get("runs")
    if isinstance(runs, list) and all(isinstance(run, dict) for run in runs):
        from pneutouch.studio.campaign import write_runs

        write_runs(path.parent, runs)
    return content


def _head(path: Path) -> object:
    """A request's head, as lines: method and path, then headers; the guard answers it before anything else does."""
    from pneutouch.studio.guard import Guard

    first, *rest = path.read_bytes().split(b"\n")
    method, _, place = first.partition(b" ")
    where, _, query = place.partition(b"?")
    headers = [(name.strip(), value.strip()) for name, _, value in (line.partition(b":") for line in rest)]
    method_, where_ = method.decode("latin-1"), where.decode("latin-1")
    scope = {"type": "http", "method": method_, "path": where_, "query_string": query, "headers": headers}
    sent: list[Any] = []

    async def application(*_: object) -> None:
        sent.append("handed on")

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(message: Any) -> None:
        sent.append(message)

    guard = Guard(application, 8123, "the-token")
    asyncio.run(guard(scope, receive, send))
    assert sent
    return sent


ALL_ERRORS = (PneutouchError,)

TARGETS: dict[str, Target] = {
    "design": Target("a.toml", _design),
    "specimen": Target("a.toml", _specimen),
    "target": Target("a.toml", _target),
    "sweep": Target("a.toml", _sweep),
    "tray": Target("a.toml", _tray),
    "tasks": Target("a.toml", _tasks),
    "tasks-csv": Target("a.csv", _tasks),
    "campaign": Target("campaign.toml", _campaign),
    "material": Target("a.toml", _of_kind("materials")),
    "printer": Target("a.toml", _of_kind("printers")),
    "gauge": Target("a.toml", _of_kind("gauges")),
    "mixing": Target("a.toml", _of_kind("mixing")),
    "calibration": Target("a.toml", _of_kind("calibrations")),
    "port": Target("a.toml", _of_kind("ports")),
    "seat": Target("a.toml", _of_kind("seats")),
    "mount": Target("a.toml", _of_kind("mounts")),
    "coupons": Target("a.toml", _coupons),
    "run-csv": Target("a.csv", _run),
    "run-xlsx": Target("a.xlsx", _run, written=archive, library="openpyxl"),
    "run-parquet": Target("a.parquet", _run, library="pyarrow"),
    "run-tdms": Target("a.tdms", _run, library="nptdms"),
    "threemf": Target("a.3mf", _threemf, written=archive),
    "recipe": Target("a.json", _recipe),
    "dataset": Target("a.nc", _dataset),
    "journal": Target("journal", _journal),
    "slice": Target("a.png", _slice),
    "stack": Target("stack.json", _stack),
    "leak": Target("figures.json", _leak),
    "prediction": Target("prediction.json", _prediction),
    "figures": Target("figures.json", _figures),
    "exported": Target("a.json", _exported),
    "question": Target("a.json", _question, allowed=ALL_ERRORS),
    "search": Target("a.json", _search),
    "measured": Target("a.json", _measured),
    "head": Target("a.txt", _head),
}
