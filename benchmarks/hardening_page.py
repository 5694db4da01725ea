"""Write docs/background/hardening.md, the bounds of every reader: ``python -m benchmarks.hardening_page``."""

from __future__ import annotations

from pathlib import Path

from benchmarks.hardening_tables import largest, sections
from pneutouch.bench.blocks import MOST_BLOCKS
from pneutouch.export import threemf_package as package
from pneutouch.export.voxels.png import MOST_PIXELS
from pneutouch.spec.files import MOST_BYTES
from pneutouch.spec.tasks import MOST_TASKS
from pneutouch.studio.guard import LARGEST_BODY
from pneutouch.studio.uploads import LARGEST_FILE
from pneutouch.tables import parquet_table, xlsx_table
from pneutouch.tables.read import MOST_NUMBERS
from pneutouch.tables.text import LONGEST_LINE
from pneutouch.workflows.sweep.dataset import MOST_BYTES as MOST_DATASET

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"

HEAD = """# Hardening

What is done so that a file or a request of others cannot stop the program or make it wait without end, and how much memory it can take.
`python -m benchmarks.hardening_page` writes this page from the constants of the code.

## Bounds of every reader

A file beyond its bound is refused; of a file that is read as a whole the message states its size and the bound.
`tests/test_limits.py` holds inputs just within and just beyond.
"""


def bounds() -> list[str]:
    mib, mb = 2**20, 1e6
    rows = (
        (
            "TOML: designs, targets, sweeps, trays, tasks, campaigns, profiles",
            f"{MOST_BYTES / mb:g} MB; keys of 32 parts; 20 problems reported",
        ),
        ("tasks as CSV", f"{MOST_BYTES / mb:g} MB, {MOST_TASKS} tasks"),
        (
            "measured run, text",
            f"any size, read in chunks; lines of {LONGEST_LINE} bytes; {MOST_BLOCKS} blocks in memory",
        ),
        (
            "measured run, parquet",
            f"{parquet_table.MOST_ROWS / mb:g} million rows, {parquet_table.MOST_UNPACKED // mib} MiB unpacked in a group of rows; {MOST_BLOCKS} blocks in memory",
        ),
        (
            "measured run, Excel",
            f"{xlsx_table.UNPACKED / mb:g} MB unpacked, {xlsx_table._PARTS} parts, {xlsx_table._ROWS} rows of {xlsx_table._COLUMNS} columns",
        ),
        ("measured run, TDMS", f"as many values as its bytes hold, {MOST_BLOCKS} blocks in memory"),
        (
            "a table in memory as a whole: tensile tests, injections, texture signals",
            f"{MOST_NUMBERS / mb:g} million numbers",
        ),
        (
            "3MF",
            f"{package.MOST_BYTES // mib} MiB in the file and inflated, {package.MOST_PARTS} parts, {package.MOST_COMPONENTS} components",
        ),
        ("voxel slice", f"100 MB, {MOST_PIXELS / mb:g} million pixels"),
        ("manifests and figures in output folders (JSON)", "100 MB"),
        ("dataset and journal of a sweep", f"{MOST_DATASET // mib} MiB"),
        ("exported design, question of the page (JSON)", f"{LARGEST_BODY // 1024} KiB"),
        ("file given to the page", f"{LARGEST_FILE // mib} MiB, 256 MiB in all"),
    )
    return ["| reader | greatest size |", "|---|---|", *(f"| {name} | {words} |" for name, words in rows), ""]


TAKEN = """## Memory and time

`tests/fuzzing/test_memory.py` and `tests/fuzzing/test_grown.py` let every list and table of an input grow, and unknown keys with them.
Peak memory, as Python counts it, is at most 256 KiB and 100 bytes for each byte of a text: most of it is the list of what is wrong.
A measured run as text takes up to 8 MiB more for a chunk of it, whatever its size.
Twice the input takes at most 2.2 times the calls of functions: no reader takes the square of its input. No clock decides.
Parquet, Excel, TDMS, datasets and slices are read by compiled libraries, whose calls Python does not see; they are in the table.
"""

KEPT = """## Inputs read again

`tests/fuzzing/targets.py` has a function for every reader of bytes of others: files, and requests of the page.
`tests/fuzzing/corpus` holds damaged and hostile inputs of each. The everyday tests read them again. A reader answers, or refuses
with its own error; every other error, a warning of numpy, or more than 128 MiB of memory for one input fails the test.

`make fuzz` looks for further ones, by the branches that inputs reach (atheris): an hour of processor time in all, three times as much
for each binary or nested format as for another. It prints the folder of its inputs; `python -m tests.fuzzing --keep --folder FOLDER`
adds the smallest that reach new code to the corpus.
"""


def page() -> str:
    return "\n".join([HEAD, *bounds(), TAKEN, *largest(), KEPT, *sections()])


if __name__ == "__main__":
    (DOCS / "hardening.md").write_text(page(), encoding="utf-8")
