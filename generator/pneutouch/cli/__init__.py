"""The command line: a module for one command or two, loaded where a command of it is used."""

import gc
import os
import signal
import sys

from pneutouch.cli.stop import StopSignals, stop_signals

__all__ = ["command_line", "run"]

_OBJECTS_BEFORE_COLLECTION = 250_000
"""Number of objects before a collection. A command ends within seconds and keeps most objects that it makes: collecting
garbage at Python's 700 is a sixth of the time that CadQuery and matplotlib take to load."""

_KEPT_BYTES = 1 << 20
"""Size in bytes of a block whose release raises the bound above which the GNU C library returns memory to the system.

Without that the arrays of each Newton step are returned and requested again: a tenth of the time of ``predict``.
"""

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables that set the number of threads of the linear algebra, here one. The order of its sums, and so the last
digits of a result, follow that number; and on a busy machine two threads wait for one another: a press off the axis
took 450 s in place of 35 s."""

_UNWOUND = 2
"""Least exit code of a command that an error or a stop signal ended."""


def run() -> None:
    """Entry point of the ``pneutouch`` command."""
    gc.set_threshold(_OBJECTS_BEFORE_COLLECTION, 50, 50)
    bytes(_KEPT_BYTES)
    # Before numpy loads.
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    # The models have no plugins: to look for some, pydantic reads the metadata of every installed package.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    with stop_signals(after=signal.SIG_IGN) as stop:
        code = command_line(stop)
    # Python notes an interrupt that passes through code given as text, such as that of a dataclass, and would end by
    # SIGINT for it; the next code given as text clears the note.
    exec("")
    # What is left ends with the process: to search it for garbage takes Python up to a tenth of a command's time.
    # A stop or an error leaves frames in reference cycles, whose objects libraries would report as leaked.
    if code < _UNWOUND:
        if "manifold3d" in sys.modules:
            # It lists on stderr what is never freed, and loading matplotlib keeps the frames of all callers in a cycle.
            gc.collect()
        gc.freeze()
    sys.exit(code)


def command_line(stop: StopSignals) -> int:
    """Run the command line ``sys.argv`` and return the exit code: 130 or 143 where ``stop`` received a signal."""
    code = 0
    try:
        # Inside, so that a stop while the first modules load ends the same way.
        from pneutouch.cli.app import invoked

        code = invoked(sys.argv[1:])
    except (Exception, KeyboardInterrupt):
        stop.end()
        if stop.received is None:
            raise
    stop.end()
    if stop.received is None:
        return code
    from pneutouch.cli.terminal import notify

    notify(stop.line)
    return stop.exit_code
