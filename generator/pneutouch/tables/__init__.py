"""Tables of numbers in CSV and parquet files, read with one set of messages."""
