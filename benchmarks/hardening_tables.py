"""The stored figures of fuzzing, mutation testing and the soak, as sections of docs/background/hardening.md."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

from benchmarks.mutant_sites import PARTS
from benchmarks.mutants import FOLDERS

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"
READ = Path(__file__).with_name("mutants_read.toml")


FAULTS = """What was wrong, and is refused now with a message that names file and fault:

| reader | input | what it did | shown by |
|---|---|---|---|
| 3MF | a part without a name | ended with a traceback | fuzzing |
| parquet | damaged statistics of a column | ended the process: pyarrow raises where nothing can catch it | fuzzing |
| tables as text, numbers of options | a cell of 65,536 digits | minutes: the pattern of numbers took the square of its length | fuzzing |
| questions of the area Measure | a pressure to hold out of 400 digits; 5,000 digits of rows to skip | ended with a traceback | fuzzing, reading the code |
| lists of numbers in the Python interface | a number of 400 digits | OverflowError in place of the project's error | reading the code |
| names of columns, lines above a tensile table | 65,536 separators | half a minute, likewise | reading the code |
| voxel slice | no columns, 4294967295 rows | unpacked 4 MB to 4 GB | reading the code |
| figures.json as a measured leak | a leak that is no finite number | counted as no leak | reading the code |
| output folder for `compare` | figures and curves that are no finite numbers | compared as they stood | reading the code |
| TDMS, LabVIEW text | a clock with an infinite step | a warning of numpy | reading the code |
"""


def sections() -> list[str]:
    """What is stored, under its heading."""
    known = {
        "## Fuzzing by coverage": ("fuzzing.json", fuzzing),
        "## Mutation testing": ("mutants-*.json", mutation),
        "## The studio in use for an hour": ("soak.json", soak),
    }
    return [line for head, (name, table) in known.items() if any(DOCS.glob(name)) for line in (head, "", *table())]


def wilson(part: int, whole: int) -> tuple[float, float]:
    """The 95 % interval of a share (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209, DOI 10.1080/01621459.1927.10502953)."""
    z, share = 1.959964, part / whole
    middle = share + z * z / (2 * whole)
    half = z * math.sqrt(share * (1 - share) / whole + z * z / (4 * whole**2))
    return (middle - half) / (1 + z * z / whole), (middle + half) / (1 + z * z / whole)


def stored(name: str) -> Any:
    return json.loads((DOCS / name).read_text(encoding="utf-8"))


LARGEST = """`python -m benchmarks.largest_inputs` writes an input of the greatest size for each reader, and has a new process read it; of a dataset a fifth, of
a journal a sixteenth of that size, for their memory rises with their size: some 15 GiB for the largest journal. Runs that are read in chunks have
100 MB. Peak memory is what the process has more than before, as the system counts it. Time is processor time over that of Python's `json.loads` for a list of
numbers of as many bytes, in the same run. `tests/fuzzing/test_largest.py` reads each again: at most 1.5 times the memory, and 64 MiB.
"""


def largest() -> list[str]:
    lines = [
        *LARGEST.splitlines(),
        "",
        "| reader | input | outcome | file, MB | unpacked, MB | peak memory, MiB | time over `json.loads` |",
        "|---|---|---|--:|--:|--:|--:|",
    ]
    for row in stored("largest-inputs.json"):
        sizes = " | ".join(f"{row[key] / 1e6:.4g}" for key in ("bytes", "unpacked_bytes"))
        taken = f"{row['mebibytes']:.0f} | {row['time_over_json']:g}"
        lines.append(f"| {row['reader']} | {row['input']} | {row['outcome']} | {sizes} | {taken} |")
    return [*lines, ""]


def fuzzing() -> list[str]:
    rows = stored("fuzzing.json")
    runs, seconds = (sum(row[key] for row in rows.values()) for key in ("runs", "seconds"))
    inputs, size = (sum(row[key] for row in rows.values()) for key in ("kept", "kept_bytes"))
    lines = [
        f"{runs:,} inputs in {seconds:.0f} s of processor time, over several runs. An edge is a branch of the readers' code, a feature an edge with how",
        "often it was taken; the first number of each is that of the shipped files and the kept inputs, the second that of the end.",
        f"{inputs} inputs of {size / 1e3:.0f} kB are kept in all.",
        "",
        "| reader | inputs | s | edges | features | corpus | kept | findings |",
        "|---|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for name, row in rows.items():
        (first, last), (few, many) = row["edges"], row["features"]
        numbers = (
            f"{row['runs']} | {row['seconds']:.0f} | {first}, {last} | {few}, {many} | {row['corpus']} | {row['kept']}"
        )
        lines.append(f"| {name} | {numbers} | {row['findings']} |")
    return [*lines, "", FAULTS]


DRAWN = """`benchmarks.mutants` draws faults with the same chance among {sites} places in mechanics, printability and bench: a comparison, a sum, a
product, a sign, a number, a condition, a result. The everyday tests of {folders} folders run against each, those first that call the changed
function, up to 45 s of processor time; slow tests, and those of pages and of the studio, are left out. {outside} of the last {last} faults are outside of
functions, mostly constants that a comment calls a choice. Every survivor was read: *equivalent* changes no result but for the number of steps that a solver takes,
*test* is noticed by a test that was written for it afterwards, *left* is neither. `make mutants` makes a draw of its own.
"""

SHARES = """A share in the last two columns is of all faults and of those that are not equivalent, by the tests as they were when the draw was made, with its 95 %
interval. Draws 1 and 2 ran the tests of seven folders alone, up to 30 or 45 s. The last draw is what a further one is to be expected near.
The table of survivors has those of the last draw and what the others left.
"""


def mutation() -> list[str]:
    draws = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(DOCS.glob("mutants-*.json"))]
    drawn = [row | {"seed": draw["seed"]} for draw in draws for row in draw["drawn"]]
    read = {(each["seed"], each["number"]): each for each in tomllib.loads(READ.read_text())["survivor"]}
    last = [row for row in drawn if row["seed"] == draws[-1]["seed"]]
    head = "faults | killed | timed out | survived | of them equivalent | killed by new tests | left"
    lines = [
        *DRAWN.format(
            sites=draws[-1]["sites"],
            folders=len(FOLDERS.split()),
            outside=sum(not row["function"] for row in last),
            last=len(last),
        ).split("\n"),
        f"| draw | {head} | noticed | of those not equivalent |",
        "|---|--:|--:|--:|--:|--:|--:|--:|---|---|",
    ]
    for draw in draws:
        counts = _counts([row for row in drawn if row["seed"] == draw["seed"]], read)
        noticed = counts[1] + counts[2]
        shares = _share(noticed, counts[0]), _share(noticed, counts[0] - counts[4])
        lines.append(f"| {draw['seed']} | {' | '.join(map(str, counts))} | {' | '.join(shares)} |")
    every = _counts(drawn, read)
    now, sound = every[1] + every[2] + every[5], every[0] - every[4]
    today = f"With the tests that were written for survivors, {_share(now, sound)} of the faults of all draws that are not equivalent are noticed."
    lines += ["", *SHARES.split("\n"), today, "", f"| part, last draw | {head} |", "|---|--:|--:|--:|--:|--:|--:|--:|"]
    for part in PARTS:
        counts = _counts([row for row in last if row["module"].startswith(f"{part}/")], read)
        lines.append(f"| {part} | {' | '.join(map(str, counts))} |")
    return [*lines, "", *_survivors(drawn, read, draws[-1]["seed"])]


def _counts(rows: list[Any], read: dict[Any, Any]) -> list[int]:
    """Faults, those of each outcome, and the survivors of each verdict."""
    outcomes = [sum(row["outcome"] == outcome for row in rows) for outcome in ("killed", "timed out", "survived")]
    verdicts = [read[row["seed"], row["number"]]["verdict"] for row in rows if row["outcome"] == "survived"]
    return [len(rows), *outcomes, *(verdicts.count(each) for each in ("equivalent", "test", "left"))]


def _share(part: int, whole: int) -> str:
    low, high = wilson(part, whole)
    return f"{100 * part / whole:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def _survivors(drawn: list[Any], read: dict[Any, Any], last: int) -> list[str]:
    """The survivors of the last draw, and those that earlier ones left."""
    lines = ["| survivor | change | what it is |", "|---|---|---|"]
    for row in sorted(drawn, key=lambda row: row["seed"] != last):
        if row["outcome"] == "survived":
            each = read[row["seed"], row["number"]]
            if row["seed"] == last or each["verdict"] == "left":
                where = f"`{row['module']}` {row['function']}".strip()
                change = row["change"].partition(": ")[2].replace("|", "\\|")
                lines.append(f"| {where} | `{change}` | {each['verdict']}: {each['words']} |")
    return [*lines, ""]


FOUND = """`make soak` lets a user act at random for an hour, in a browser: sliders, other designs, values that are refused, undo, pins, other areas.
The other areas are filled when they are first shown: elements and listeners rise once, here near the end.
"""


def soak() -> list[str]:
    found = stored("soak.json")
    acts = ", ".join(f"{name} {count}" for name, count in found["acts"].items())
    head = ["| minutes | acts | elements | listeners | scripts, MB | processes, MB |", "|--:|--:|--:|--:|--:|--:|"]
    lines = [*FOUND.split("\n"), *head]
    for row in found["points"]:
        lines.append(
            f"| {row['minutes']:.0f} | {row['acts']} | {row['nodes']} | {row['listeners']} | {row['scripts_mb']:.1f} | {row['processes_mb']} |"
        )
    return [*lines, "", f"Acts: {acts}.", ""]
