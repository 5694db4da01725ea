"""Every reader of files of others, as a function of a path."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.spec.read import read_toml, validate
from tests.fuzzing.place import ROOT


@cache
def library() -> Library:
    return CachedLibrary((ROOT,))


def reader_of(kind: str) -> Callable[[Path], object]:
    def read(path: Path) -> object:
        from pneutouch.catalogue import KINDS

        return KINDS[kind].validate(read_toml(path), str(path))

    return read


def read_design(path: Path) -> object:
    return load_scene(DesignSource.of(str(path), library()), {}, library())


def read_specimen(path: Path) -> object:
    from pneutouch.workflows.specimen.draw import load_specimen

    return load_specimen(str(path), {}, library())


def read_target(path: Path) -> object:
    from pneutouch.spec.target import Target as TargetFile

    return validate(TargetFile, read_toml(path), str(path))


def read_sweep(path: Path) -> object:
    from pneutouch.workflows.sweep.grid import plan_of_file

    return plan_of_file(path)


def read_tray(path: Path) -> object:
    from pneutouch.workflows.tray.order import order_of_file

    return order_of_file(path)


def read_tasks(path: Path) -> object:
    from pneutouch.spec.tasks import read_tasks

    return read_tasks(path)


def read_campaign(path: Path) -> object:
    from pneutouch.spec.campaign import campaign_of, design_of

    campaign, folder = campaign_of(path)
    return design_of(campaign, folder)


def read_coupons(path: Path) -> object:
    from pneutouch.spec.coupon import read_results

    return read_results(path)


def read_run(path: Path) -> object:
    from pneutouch.bench.reading import PLATE, read_blocks
    from pneutouch.bench.source import identify
    from pneutouch.spec.campaign import ColumnMap, FileFormat, Rig

    return read_blocks(identify(path, ColumnMap(), PLATE, FileFormat()), Rig())


def read_threemf(path: Path) -> object:
    from pneutouch.export.threemf_read import read_threemf
    from pneutouch.output.recipe import read_recipe

    return read_recipe(read_threemf(path))


def read_recipe(path: Path) -> object:
    """A recipe as the text that a 3MF holds, with the hash that belongs to it where it has one."""
    from pneutouch.export.threemf_read import Package
    from pneutouch.output.files import input_hash
    from pneutouch.output.recipe import read_recipe

    text = path.read_bytes().decode("utf-8", "replace")
    try:
        content = json.loads(text)
        stated = {"input-hash": input_hash(content["inputs"], content["version"])}
    except (ValueError, TypeError, KeyError, RecursionError):
        stated = {}
    return read_recipe(Package(path, (), stated, text, False, ()))


def read_dataset(path: Path) -> object:
    from pneutouch.workflows.sweep.dataset import stored_dataset, stored_fingerprint

    stored_fingerprint(path)
    return stored_dataset(path)


def read_journal(path: Path) -> object:
    from pneutouch.workflows.sweep.journal import Journal, _checksum

    lines = path.read_bytes().split(b"\n")
    path.write_bytes(b"".join(_checksum(line) + b" " + line + b"\n" for line in lines))
    counts: list[int] = []
    Journal(path, "ab").read(lambda records, _: counts.append(len(records)))
    return counts


def read_slice(path: Path) -> object:
    from pneutouch.export.voxels.png import decode

    return decode(path.read_bytes(), str(path))


def read_stack(path: Path) -> object:
    from pneutouch.export.voxels.stack import read_stack

    return read_stack(path.parent)


def read_leak(path: Path) -> object:
    from pneutouch.workflows.driving.pressures import _of_campaign

    return _of_campaign(path, "paper-dome")


def read_prediction(path: Path) -> object:
    """The prediction of an output folder, by one who makes its manifest agree with it."""
    from pneutouch.formats import format_of
    from pneutouch.output.files import MANIFEST, digest
    from pneutouch.workflows.compare import of_build
    from tests.fuzzing.seeds import recipe

    inputs, version, stated = recipe()
    files = {path.name: {"sha256": digest(path.read_bytes())}}
    head = {
        "format": format_of("manifest"),
        "name": "a",
        "inputs": inputs,
        "versions": {"pneutouch": version},
        "input_hash": stated,
    }
    (path.parent / MANIFEST).write_text(json.dumps(head | {"files": files}))
    return of_build(path.parent).sensor({})


def read_figures(path: Path) -> object:
    """The figures of a folder of results, likewise."""
    from pneutouch.formats import format_of
    from pneutouch.output.files import MANIFEST, digest
    from pneutouch.workflows.compare_measured import measured_columns
    from tests.fuzzing.seeds import POINTS

    (path.parent / "points.csv").write_bytes(POINTS)
    files = {name: {"sha256": digest((path.parent / name).read_bytes())} for name in (path.name, "points.csv")}
    (path.parent / MANIFEST).write_text(json.dumps({"format": format_of("manifest"), "name": "a", "files": files}))
    return measured_columns(path.parent)
