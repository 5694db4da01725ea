"""Every reader of what the page sends, as a function of the path of a file that holds it."""

from __future__ import annotations

import asyncio
from functools import cache
from pathlib import Path
from typing import Any

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from tests.fuzzing.files import library


def read_exported(path: Path) -> object:
    from pneutouch.studio.design_jobs import open_file

    files = [{"name": path.name, "path": str(path)}]
    return open_file({"files": files, "bases": _bases()}, path.parent, lambda done, total, what: None)


@cache
def _bases() -> dict[str, str]:
    return {name: name for name in library().paths("designs")}


def read_question(path: Path) -> object:
    """The body of a question, as the page sends it, to its answer by the atlas."""
    from pneutouch.studio.form import Question

    question = Question.of(_body(path))
    load_scene(question.source(_bases(), library()), {}, library())
    return _answers().quick(question)


@cache
def _answers() -> Any:
    from pneutouch.studio.answer import Answers

    return Answers(_bases(), library())


def read_search(path: Path) -> object:
    from pneutouch.studio.form import Question
    from pneutouch.studio.search import target_of

    return target_of(Question.of(_body(path)), _bases())


def _body(path: Path) -> Any:
    from starlette.requests import Request

    from pneutouch.studio.form import json_body

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": path.read_bytes(), "more_body": False}

    request = Request({"type": "http", "method": "POST", "headers": []}, receive)
    return asyncio.run(json_body(request, "question"))


def read_measured(path: Path) -> object:
    """What the page states of measured files: the arguments of a job."""
    from pneutouch.spec.options import CalibrationOptions, options_of
    from pneutouch.studio import measuring

    content = _body(path)
    if not isinstance(content, dict):
        raise InputError("no object")
    measuring._reading(content)
    for key in ("sensor", "save"):
        measuring._text(content, key)
    for key in ("fit", "paths"):
        measuring._texts(content, key)
    options_of(CalibrationOptions, content)
    runs = content.get("runs")
    if isinstance(runs, list) and all(isinstance(run, dict) for run in runs):
        from pneutouch.studio.measured import write_runs

        write_runs(path.parent, runs)
    return content


def read_head(path: Path) -> object:
    """A request's head, as lines: method and path, then headers; the guard answers it before anything else does."""
    from pneutouch.studio.guard import Guard

    first, *rest = path.read_bytes().split(b"\n")
    method, _, place = first.partition(b" ")
    where, _, query = place.partition(b"?")
    headers = [(name.strip(), value.strip()) for name, _, value in (line.partition(b":") for line in rest)]
    method_, where_ = method.decode("latin-1"), where.decode("latin-1")
    scope = {"type": "http", "method": method_, "path": where_, "query_string": query, "headers": headers}
    sent: list[Any] = []

    async def application(*_: object) -> None:
        sent.append("handed on")

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(message: Any) -> None:
        sent.append(message)

    guard = Guard(application, 8123, "the-token")
    asyncio.run(guard(scope, receive, send))
    assert sent
    return sent
