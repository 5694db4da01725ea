"""Accuracy and time of an exported reader: ``python -m benchmarks.reader [DESIGN]``. Needs gcc."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.export.reader.render import c_name, table_bytes
from pneutouch.workflows.export_reader import make_reader

READINGS = 2_000_000

MAIN = """
#include <stdio.h>
#include <time.h>
#include "NAME_reader.h"
int main(void)
{
    NAME_reader reader;
    NAME_reading reading;
    float sum = 0.0f;
    clock_t start;
    long k;
    NAME_begin(&reader);
    NAME_add(&reader, DRIVINGf);
    NAME_tare(&reader, 20.0f, UPPER_AMBIENT_KPA);
    start = clock();
    for (k = 0; k < COUNTL; k++) {
        if (NAME_read(&reader, DRIVINGf + RISEf * (float)(k % 1000), 20.0f + (float)(k % 3),
                      UPPER_AMBIENT_KPA + (float)(k % 4) * 0.5f, &reading) <= UPPER_ABOVE_RATING) {
            sum += reading.force_N;
        }
    }
    printf("%.3f us a reading (%g N in all)\\n", 1e6 * (double)(clock() - start) / CLOCKS_PER_SEC / COUNT, (double)sum);
    return 0;
}
"""


def main(design: str) -> None:
    """Print the largest differences from the full model, the size of the tables and the time of a reading."""
    result = make_reader(evaluate(design, model="auto"))
    known, box = result.document["difference"], result.document["box"]
    print(
        f"{design}: {known['nominal_percent']:.3f} % of {box['contact_force_N'][1]:.4g} N in {known['states']} states;"
    )
    print(
        f"at other conditions {known['other_conditions_percent']:.3f} %; tables of {table_bytes(result.document)} bytes"
    )
    name = c_name(result.name.removesuffix("-reader"))
    middle = sum(box["driving_pressure_kPa"]) / 2
    words = {
        "NAME": name,
        "UPPER": name.upper(),
        "COUNT": str(READINGS),
        "DRIVING": f"{middle:.6f}",
        "RISE": f"{box['pressure_rise_kPa'][1] / 2000:.6f}",
    }
    program = MAIN
    for word, value in words.items():
        program = program.replace(word, value)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / f"{name}_reader.h").write_bytes(result.files[f"{name}_reader.h"])
        (folder / "main.c").write_text(program)
        subprocess.run(["gcc", "-O2", "-std=c99", "main.c", "-o", "main"], cwd=folder, check=True)
        print(subprocess.run([folder / "main"], capture_output=True, text=True, check=True).stdout, end="")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "paper-dome")
