"""The files of a reader from its document, with the sketch that reads its gauge: bytes by file name."""

import pprint
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch.export import templates
from pneutouch.export.reader.reading import NOISES, QUIET, Status
from pneutouch.spec.gauge import Gauge
from pneutouch.wording import data_of

_BUS = "ABP2"
"""Order codes that begin so have the protocol of the sketch: command AA 00 00, 5 ms, seven bytes with pressure
and temperature of 24 bits (drivers Linux abp2030pa and ESPHome honeywellabp2)."""


@dataclass(frozen=True, slots=True)
class SketchGauge:
    """A gauge as a sketch reads it: kPa = low + slope (output - at_low), float32 literals of C, in volts or by bus."""

    low: str
    at_low: str
    slope: str
    volts: bool
    bus: bool = False
    address: int | None = None


def arduino_gauge(gauge: Gauge) -> SketchGauge | str:
    """The gauge as a sketch reads it; or the reason why there is no sketch, in words."""
    if gauge.is_absolute:
        return f"no sketch: the {gauge.title} is absolute, and its reading less a barometer's is the gauge pressure"
    if gauge.transfer.at_low is None or gauge.transfer.at_high is None:
        return f"no sketch: the {gauge.title} has constants in each part, which a driver of its maker reads"
    slope = gauge.range_kPa.span / (gauge.transfer.at_high - gauge.transfer.at_low)
    low, at_low, volts = gauge.range_kPa.low, gauge.transfer.at_low, gauge.transfer.output == "V"
    numbers = SketchGauge(f32(low), f32(at_low), f32(slope), volts)
    if gauge.transfer.output != "count":
        return numbers
    if not gauge.order_code.startswith(_BUS) or "I2C" not in gauge.interfaces or gauge.i2c_address is None:
        return f"no sketch: how the {gauge.title} is read over its bus is not covered"
    return replace(numbers, bus=True, address=gauge.i2c_address)


NO_GAUGE = "no sketch: the design names no gauge, see pneumatics.gauge"


HERE = Path(__file__).parent
SCHEMA = HERE / "reader.schema.json"

MOST_TABLES = 8192
"""Greatest size of the tables of a header, bytes."""

WORDS: dict[str, str] = data_of(__file__)
"""Meaning of each status."""

_PARTS = ("format", "grid", "gas", "box", "rating", "gauge", "zero", "conditions")


def reader_files(record: Mapping[str, Any], name: str, gauge: Gauge | None = None) -> dict[str, bytes]:
    """All files of a reader but ``reader.json``, by name; ``name`` becomes the prefix of files and of C names.

    A sketch is among them if it can read the gauge: see `sketch_note`.
    """
    c = c_name(name)
    # `reading` without its docstring: the module that is shipped is the one that is used here.
    source = (HERE / "reading.py").read_text(encoding="utf-8").split('"""', 2)[2].lstrip("\n")
    table = pprint.pformat({key: record[key] for key in _PARTS}, width=118, compact=True)
    statuses = [{"name": one.name, "value": int(one), "words": WORDS[one.name]} for one in Status]
    values = {"bytes": table_bytes(record), "half": _half, "below": NOISES, "quiet": QUIET}
    header = _rendered("reader.h.j2", record, c=c, statuses=statuses, **values)
    files = {
        "reader.schema.json": SCHEMA.read_bytes(),
        f"{c}_reader.h": header,
        f"{c}_reader.py": _rendered("reader.py.j2", record, c=c, source=source, table=table),
    }
    known = None if gauge is None else arduino_gauge(gauge)
    if isinstance(known, SketchGauge):
        # The compiler of a sketch looks for headers in the sketch's own folder.
        files[f"arduino/{c}_sketch/{c}_sketch.ino"] = _rendered("reader.ino.j2", record, c=c, gauge=known)
        files[f"arduino/{c}_sketch/{c}_reader.h"] = header
    return files


def sketch_note(gauge: Gauge | None) -> str | None:
    """Reason why there is no sketch, or None if there is one."""
    known = NO_GAUGE if gauge is None else arduino_gauge(gauge)
    return known if isinstance(known, str) else None


def c_name(name: str) -> str:
    """An identifier of C from a name: other characters become underscores; before a digit stands ``sensor_``."""
    plain = re.sub(r"\W", "_", name, flags=re.ASCII).lower()
    return f"sensor_{plain}" if not plain[:1].isalpha() else plain


def f32(value: float) -> str:
    """A float32 literal of C."""
    text = f"{value:.9g}"
    return f"{text}f" if "." in text or "e" in text else f"{text}.0f"


def _rendered(template: str, record: Mapping[str, Any], **more: Any) -> bytes:
    # Program text; the names in it are those of files, which hold no markup.
    environment = templates(HERE / "templates", autoescape=False)
    environment.filters["f32"] = f32
    return environment.get_template(template).render(record=record, **more).encode() + b"\n"


def table_bytes(record: Mapping[str, Any]) -> int:
    """Size of the tables of the header, bytes."""
    grid = record["grid"]
    rows, columns = len(grid["contact_force_N"]), len(grid["contact_force_N"][0])
    relative = grid["force_uncertainty_relative"]
    shares = len(relative[0]) if relative else 0
    return 4 * (rows * (2 * columns + shares + 1) + len(record["gas"]["volume_mL"]))


def _half(intervals: int) -> int:
    """The first step of a binary search among ``intervals`` intervals: a power of two."""
    return 1 << max((intervals - 1).bit_length() - 1, 0)
