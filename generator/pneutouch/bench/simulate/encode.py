"""A simulated record as the bytes of a file, marked as simulated."""

import io

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError

LEAK_SECONDS = 600.0
"""Duration of a leak run, s: our choice, as long as the relaxation run."""

MARK = "# simulated by pneutouch"
"""First line of every file."""

_DECIMALS = {"time_s": 6, "position_mm": 5, "force_N": 5, "pressure_kPa": 6, "volume_mL": 4}
"""Decimals in files: a hundredth of the finest noise."""


def encoded(columns: dict[str, Array], *, parquet: bool = False) -> bytes:
    """Columns as CSV or parquet, marked as simulated. Raises InputError if pyarrow is required and missing."""
    rounded = {name: np.round(values, _DECIMALS[name]) + 0.0 for name, values in columns.items()}
    if not parquet:
        from pandas import DataFrame

        return f"{MARK}\n{DataFrame(rounded).to_csv(index=False, lineterminator=chr(10))}".encode()
    try:
        import pyarrow
        from pyarrow import parquet as files
    except ImportError:
        remedy = "pip install 'pneutouch[parquet]', or leave it out for CSV"
        raise InputError("needs pyarrow", key="parquet", remedy=remedy) from None
    table = pyarrow.table(rounded).replace_schema_metadata({"comment": MARK.removeprefix("# ")})
    target = io.BytesIO()
    files.write_table(table, target)
    return target.getvalue()
