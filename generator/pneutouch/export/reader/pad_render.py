"""The files of a pad's reader from its table: bytes by file name."""

import pprint
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.export import templates
from pneutouch.export.reader import pad_reading
from pneutouch.export.reader.render import HERE, c_name, f32


@dataclass(frozen=True)
class PadReaderSource:
    """Origin of a pad's reader: name of the pad, driving pressure (kPa), name of the calibration (None: none),
    version of this program, and SHA-256 of the table."""

    pad: str
    driving_pressure_kPa: float
    calibration: str | None
    version: str
    sha256: str


def pad_reader_files(table: Mapping[str, Any], source: PadReaderSource) -> dict[str, bytes]:
    """Header of C99 and Python module of a table of `mechanics.touch.reader_table`."""
    name = c_name(source.pad)
    environment = templates(HERE / "templates", autoescape=False)
    environment.filters["f32"] = f32
    record = {"table": table, **{key: getattr(source, key) for key in source.__dataclass_fields__}}
    header = environment.get_template("pad_reader.h.j2").render(
        record=record,
        c=name,
        kinds=pad_reading.KINDS,
        of_kind=pad_reading.STARTS,
        fits=sum(pad_reading.STARTS),
        steps=pad_reading.STEPS,
        settled=pad_reading.SETTLED,
        hopeless=pad_reading.HOPELESS,
        follow=pad_reading.FOLLOW,
        misfit=pad_reading.MISFIT,
        sure=pad_reading.SURE,
    )
    # `pad_reading` without its docstring: the module that is shipped is the one that is tested here.
    code = (HERE / "pad_reading.py").read_text(encoding="utf-8").split('"""', 2)[2].lstrip("\n")
    data = pprint.pformat(dict(table), width=118, compact=True, sort_dicts=False)
    module = environment.get_template("pad_reader.py.j2").render(record=record, source=code, table=data)
    return {f"{name}_reader.h": header.encode() + b"\n", f"{name}_reader.py": module.encode() + b"\n"}
