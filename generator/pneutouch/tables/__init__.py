"""Tables of numbers in text files, workbooks, parquet and TDMS files, read with one set of messages."""
