"""The tests of a changed module, each change in a forked process of one that has collected them: `tests.mutants`."""

from __future__ import annotations

import ast
import gc
import importlib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import types
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.mutants.sites import PACKAGE, PARTS, Site, changed

Calls = dict[str, tuple[float, list[str]]]
"""Of every test that passes: processor time in seconds, and the functions of ``PARTS`` that it calls."""

MOST = 45.0
"""Processor time in seconds of the unchanged tests that are run for a change; those that take least go first."""

SLOWER, ALLOWED = 4.0, 20.0
"""A changed program may take so many times as long, and so many seconds more: then it timed out."""


def name_of(path: Path) -> str:
    return ".".join(("pneutouch", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")


class Driver:
    """A plugin of pytest: instead of running what was collected, it runs ``work``, which forks."""

    def __init__(self, work: Callable[[Driver], None]) -> None:
        self.work = work
        self.items: dict[str, pytest.Item] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self.session = session
        self.items = {item.nodeid: item for item in session.items}
        for part in PARTS:
            for path in sorted((PACKAGE / part).rglob("*.py")):
                importlib.import_module(name_of(path))
        self.functions = _functions()
        gc.collect()
        gc.freeze()
        try:
            self.work(self)
        except BaseException:
            traceback.print_exc()
            raise
        return True

    def forked(self, job: Callable[[], int], seconds: float | None = None) -> tuple[int, float]:
        """The exit code of a job in a process of its own, negative where a signal ended it, and its processor time."""
        folder = Path(tempfile.mkdtemp(prefix="mutant-"))
        if (child := os.fork()) == 0:
            try:
                if seconds is not None:
                    bound(seconds)
                nothing = os.open(os.devnull, os.O_RDWR)
                for stream in (0, 1, 2):
                    os.dup2(nothing, stream)
                # What a changed program writes into the folder of a session must not reach the next.
                self.session.config._tmp_path_factory._basetemp = folder  # type: ignore[attr-defined]
                code = job()
            except BaseException:
                code = 3
            os._exit(code)
        _, status, usage = os.wait4(child, 0)
        shutil.rmtree(folder, ignore_errors=True)
        return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime

    def run(self, item: pytest.Item, following: pytest.Item | None) -> bool:
        """Whether a test passes."""
        before = self.session.testsfailed
        self.session.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        return self.session.testsfailed == before

    def outcome(self, site: Site, names: list[str], seconds: float) -> tuple[str, float]:
        """Killed, timed out or survived: the tests of these names with a function changed; and the processor time."""
        code = _code_of(compile(changed(site)[0], str(site.path), "exec"), site.outer)

        def job() -> int:
            for function in self.functions[str(site.path), *site.outer]:
                function.__code__ = code
            items = [self.items[name] for name in names]
            for item, following in zip(items, [*items[1:], None], strict=True):
                if not self.run(item, following):
                    return 1
            return 0

        return stated(*self.forked(job, seconds * SLOWER + ALLOWED))

    def calls(self, file: Path) -> None:
        """Write which functions every test calls: `Calls`, as JSON."""

        def job() -> int:
            calls: Calls = {}
            items = list(self.items.values())
            for item, following in zip(items, [*items[1:], None], strict=True):
                called, start = set[types.CodeType](), time.process_time()
                sys.settrace(lambda frame, event, argument, called=called: called.add(frame.f_code))
                passed = self.run(item, following)
                sys.settrace(None)
                names = {f"{code.co_filename}:{code.co_qualname}" for code in called if _of_ours(code.co_filename)}
                if passed:
                    calls[item.nodeid] = (time.process_time() - start, sorted(names))
            file.write_text(json.dumps(calls))
            return 0

        print("calls of every test: exit code, s", *self.forked(job), flush=True)


def bound(seconds: float) -> None:
    """Let this process end by a signal after its processor time, or after very long by the clock, and refuse it too much memory."""
    resource.setrlimit(resource.RLIMIT_CPU, (round(seconds) + 1,) * 2)
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30,) * 2)
    signal.alarm(round(30 * seconds))


def stated(code: int, seconds: float) -> tuple[str, float]:
    return ("timed out" if code < 0 else "survived" if code == 0 else "killed"), seconds


def _of_ours(file: str) -> bool:
    return any(file.startswith(f"{PACKAGE}/{part}/") for part in PARTS)


def _functions() -> dict[tuple[str, str, int], list[types.FunctionType]]:
    """All functions of ``PARTS`` that there are, by file, name and first line."""
    found: dict[tuple[str, str, int], list[types.FunctionType]] = {}
    for each in gc.get_objects():
        if isinstance(each, types.FunctionType) and _of_ours(each.__code__.co_filename):
            code = each.__code__
            found.setdefault((code.co_filename, code.co_qualname, code.co_firstlineno), []).append(each)
    return found


def _code_of(code: types.CodeType, outer: tuple[str, int]) -> types.CodeType:
    def inside(code: types.CodeType) -> Iterator[types.CodeType]:
        yield code
        for each in code.co_consts:
            if isinstance(each, types.CodeType):
                yield from inside(each)

    [found] = [each for each in inside(code) if (each.co_qualname, each.co_firstlineno) == outer]
    return found


def cold(site: Site, tree: ast.Module, names: list[str], seconds: float) -> tuple[str, float]:
    """The same of a change outside of functions: in a process that has not imported the package."""
    from importlib.machinery import SourceFileLoader

    if (child := os.fork()) == 0:
        bound(seconds * SLOWER + 2 * ALLOWED)
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        code, load = compile(tree, str(site.path), "exec"), SourceFileLoader.get_code
        here: Any = lambda self, name: code if name == name_of(site.path) else load(self, name)  # noqa: E731
        SourceFileLoader.get_code = here  # type: ignore[method-assign]
        folder = tempfile.mkdtemp(prefix="mutant-")
        result = int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", f"--basetemp={folder}", *names]))
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(result)
    _, status, usage = os.wait4(child, 0)
    return stated(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime)
