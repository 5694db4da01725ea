"""The process behind the page: one question in it, one that waits, and the newest wins."""

from __future__ import annotations

import asyncio
import io
import json

import pytest

from pneutouch.studio.solver import Solver, SupersededError, work


class Held(Solver):
    """Answers when it is let go, without a process; what was ended is counted."""

    def __init__(self) -> None:
        super().__init__({})
        self.let_go, self.begun, self.ended = asyncio.Event(), [], 0

    async def _exchange(self, request):
        self.begun.append(request["question"])
        await self.let_go.wait()
        return {"status": 200, "content": request["question"]}

    async def close(self) -> None:
        self.ended += 1


async def settled() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


def test_of_fifty_questions_the_first_and_the_newest_are_answered():
    async def run():
        solver = Held()
        tasks = []
        for number in range(50):
            tasks.append(asyncio.create_task(solver.request({"number": number})))
            await settled()
        # Those in between have their answer before the first one has: nothing piles up.
        assert [task.done() for task in tasks] == [False, *[True] * 48, False]
        solver.let_go.set()
        return solver, await asyncio.gather(*tasks, return_exceptions=True)

    solver, answers = asyncio.run(run())
    assert [answers[0]["content"], answers[-1]["content"]] == [{"number": 0}, {"number": 49}]
    assert all(isinstance(answer, SupersededError) for answer in answers[1:-1])
    assert solver.begun == [{"number": 0}, {"number": 49}]
    assert solver.ended == 0


def test_a_computation_that_takes_long_gives_way_to_a_newer_question(monkeypatch):
    monkeypatch.setattr("pneutouch.studio.solver._PATIENCE", 0)

    async def run():
        solver = Held()
        first = asyncio.create_task(solver.request({"number": 0}))
        await settled()
        assert not first.done()
        second = asyncio.create_task(solver.request({"number": 1}))
        with pytest.raises(SupersededError):
            await first
        solver.let_go.set()
        return solver.ended, await second

    ended, answer = asyncio.run(run())
    assert ended == 1
    assert answer["content"] == {"number": 1}


def test_a_question_that_is_taken_back_frees_its_place():
    async def run():
        solver = Held()
        first = asyncio.create_task(solver.request({"number": 0}))
        await settled()
        second = asyncio.create_task(solver.request({"number": 1}))
        await settled()
        second.cancel()
        await settled()
        solver.let_go.set()
        await first
        return await solver.request({"number": 2})

    assert asyncio.run(run())["content"] == {"number": 2}


def test_the_process_answers_an_error_as_the_page_takes_it():
    request = {
        "question": {"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "60"}},
        "bases": {"paper-dome": "paper-dome"},
    }
    answers = io.BytesIO()
    work([json.dumps(request).encode()], answers)
    answer = json.loads(answers.getvalue())
    assert answer == {
        "status": 422,
        "content": {"problems": [{"message": "must be from 0.05 to 50 mm", "fields": ["membrane.wall_thickness_mm"]}]},
    }


@pytest.mark.slow
def test_a_process_that_was_ended_is_reported_and_another_answers():
    question = {"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "60"}}

    async def run():
        solver = Solver({"paper-dome": "paper-dome"})
        try:
            first = asyncio.create_task(solver.request(question))
            while solver._process is None:
                await asyncio.sleep(0.01)
            solver._process.kill()
            return await first, await solver.request(question)
        finally:
            await solver.close()

    ended, answered = asyncio.run(run())
    assert ended["status"] == 500
    assert "ended from outside" in ended["content"]["problems"][0]["message"]
    assert answered["status"] == 422
