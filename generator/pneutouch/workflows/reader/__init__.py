"""A sensor's pressure-to-force model for a microcontroller, for Python and for other programs."""

from pneutouch.workflows.reader.run import ReaderResult, make_reader, write_reader

__all__ = ["ReaderResult", "make_reader", "write_reader"]
