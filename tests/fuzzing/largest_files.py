"""Files of the greatest size that each reader takes: `tests.fuzzing.largest`."""

from __future__ import annotations

import itertools
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from pneutouch.export.voxels.png import MOST_PIXELS, encode, table
from pneutouch.spec.files import MOST_BYTES
from pneutouch.studio.guard import LARGEST_BODY
from tests.fuzzing.seeds import seeds

PARQUET, WORKBOOK, MODEL = 1.0e9, 99e6, 255 * 2**20
"""Bytes unpacked: just within the bounds of the readers."""


def _filled(path: Path, most: float, head: bytes, lines: Iterator[bytes], tail: bytes = b"") -> None:
    """Write a head, as many lines as there is room for, and a tail."""
    size = len(head) + len(tail)
    with path.open("wb") as file:
        file.write(head)
        for line in lines:
            size += len(line)
            if size > most:
                break
            file.write(line)
        file.write(tail)


def toml_numbers(path: Path) -> None:
    text = '[membrane]\nmaterial = "TangoPlus"\n[pneumatics]\ndriving_pressures_kPa = ['
    _filled(path, MOST_BYTES, text.encode(), itertools.repeat(b"0,"), b"0]\n")


def toml_keys(path: Path) -> None:
    _filled(path, MOST_BYTES, b"", (b"k%d=0\n" % k for k in itertools.count()))


def toml_runs(path: Path) -> None:
    text = b'design = "paper-dome"\n'
    _filled(path, MOST_BYTES, text, (b'[[runs]]\nfile="%d.csv"\nkind="steps"\n' % k for k in itertools.count()))


def task_rows(path: Path) -> None:
    _filled(path, MOST_BYTES, b"force_range_N\n", itertools.repeat(b"15\n"))


def _run() -> Iterator[tuple[float, float, float, float]]:
    """Time in s, position in mm, force in N and pressure in kPa: presses of two seconds."""
    for k in itertools.count():
        depth = 5 * abs((k % 2000) / 1000 - 1)
        force = 0.25 * depth**1.5
        yield k / 1000, depth, force, 12 + 2.4 * force + 0.02 * force**2


def run_rows(path: Path) -> None:
    rows = (b"%.3f,%.4f,%.4f,%.4f\n" % row for row in _run())
    _filled(path, 100e6, b"time_s,position_mm,force_N,pressure_kPa\n", rows)


def _columns(size: float) -> dict[str, np.ndarray]:
    time = np.arange(int(size / 32)) / 1000
    depth = 5 * np.abs(time % 2 - 1)
    force = 0.25 * depth**1.5
    return {"time_s": time, "position_mm": depth, "force_N": force, "pressure_kPa": 12 + 2.4 * force + 0.02 * force**2}


def parquet(path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    columns = _columns(PARQUET)
    pq.write_table(pa.table(columns), path, row_group_size=len(columns["time_s"]), use_dictionary=False)


def workbook(path: Path) -> None:
    """One sheet with a run."""
    from openpyxl import Workbook

    book = Workbook()
    book.worksheets[0].append(["time_s", "position_mm", "force_N", "pressure_kPa"])
    book.save(path)
    with zipfile.ZipFile(path) as file:
        parts = {name: file.read(name) for name in file.namelist()}
    place = "xl/worksheets/sheet1.xml"
    head, end, tail = parts[place].partition(b"</row>")
    cells = (
        b'<row r="%d">' % (k + 2) + b"".join(b"<c><v>%.4f</v></c>" % each for each in row) + b"</row>"
        for k, row in enumerate(_run())
    )
    _filled(path, WORKBOOK, head + end, cells, tail)
    parts[place] = path.read_bytes()
    _packed(path, parts)


def parts_of(target: str) -> dict[str, bytes]:
    """The parts of the first input of a target that is an archive."""
    pieces = (b"\n" + seeds(target)[0]).split(b"\n=== ")[1:]
    return {name.decode(): body for name, _, body in (piece.partition(b"\n") for piece in pieces)}


def _packed(path: Path, text: dict[str, bytes]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, body in text.items():
            file.writestr(name, body)


def tdms(path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as file:
        columns = _columns(100e6).items()
        file.write_segment([ChannelObject("run", name, values) for name, values in columns])


def model(path: Path) -> None:
    text = parts_of("threemf")
    place = "3D/3dmodel.model"
    head, mark, tail = text[place].partition(b"</triangles>")
    side = b'<triangle v1="0" v2="2" v3="1"/>'
    text[place] = head + side * ((MODEL - len(head) - len(tail)) // len(side)) + mark + tail
    _packed(path, text)


def pixels(path: Path) -> None:
    side = int(MOST_PIXELS**0.5)
    path.write_bytes(encode(np.zeros((side, side), np.uint8), table([(1, 2, 3, 255)]), (600, 300)))


def empty_lists(path: Path) -> None:
    _filled(path, 100e6, b'{"design": "paper-dome", "injections": [[]', itertools.repeat(b",[]"), b"]}")


def dataset(path: Path) -> None:
    import xarray

    from pneutouch.formats import KEY, format_of
    from pneutouch.workflows.sweep.dataset import _CONTENT_HASH, _UNHASHED, seal

    count = 250_000
    columns = {f"v{k}_N": (("point",), np.arange(float(count)), {"units": "N"}) for k in range(100)}
    words = {"status": (("point",), np.array(["ok"] * count, object), {})}
    content = xarray.Dataset(
        columns | words, {"point": ("point", np.arange(count, dtype=np.int32))}, {"input_hash": "ab"}
    )
    content.attrs[KEY] = format_of("dataset")
    content.attrs[_CONTENT_HASH] = _UNHASHED.decode()
    content.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")
    seal(path)


def journal(path: Path) -> None:
    values = {f"v{k}": 1.0 for k in range(30)}
    records = ({"point": k, "states": [{"status": "ok"}], "values": values} for k in itertools.count())
    lines = (json.dumps({"sweep": "ab", "records": [each]}).encode() + b"\n" for each in records)
    _filled(path, 64e6, b"", lines)


def exported(path: Path) -> None:
    _values(
        path, b'{"format": "pneutouch/exported-design/1", "version": "1.0", "base": "paper-dome", "values": {"a": ""'
    )


def question(path: Path) -> None:
    _values(path, b'{"base": "paper-dome", "values": {"a": ""')


def _values(path: Path, head: bytes) -> None:
    _filled(path, LARGEST_BODY, head, (b',"k%d":""' % k for k in itertools.count()), b"}}")
