"""Files that the page was given: names, sizes, and what is kept."""

from __future__ import annotations

import asyncio

import pytest

from pneutouch.errors import InputError
from pneutouch.studio import guard as kept
from pneutouch.studio.guard import Uploads
from tests.refusals import refused
from tests.studio.conftest import HOME

SENT = {"Origin": HOME, "Content-Type": "application/octet-stream"}


async def parts(*content: bytes):
    for part in content:
        yield part


def add(uploads: Uploads, name: str, *content: bytes) -> int:
    return asyncio.run(uploads.add(name, parts(*content)))


def test_a_file_is_kept_as_it_is(tmp_path):
    uploads = Uploads(tmp_path)
    first, second = add(uploads, "run 1.csv", b"a", b"b"), add(uploads, "run 1.csv", b"c")
    assert [uploads[number].path.read_bytes() for number in (first, second)] == [b"ab", b"c"]
    assert [uploads[number].bytes for number in (first, second)] == [2, 1]


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", "../a.csv", "a/b.csv", "a\\b.csv", ".hidden", "a\0.csv", "a\n.csv", "-rf", "é.csv", "a" * 200],
)
def test_names_that_are_paths_or_hidden_are_refused(name, tmp_path):
    with refused("name"):
        add(Uploads(tmp_path), name, b"x")
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_too_large_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "LARGEST_FILE", 10)
    with refused("a.csv"):
        add(Uploads(tmp_path), "a.csv", b"12345", b"678901")
    assert list(tmp_path.iterdir()) == []


def test_the_oldest_go_first_where_they_are_too_much(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_LARGEST_SUM", 10)
    uploads = Uploads(tmp_path)
    numbers = [add(uploads, "a.csv", b"1234") for _ in range(4)]
    assert sorted(tmp_path.iterdir()) == sorted(uploads[number].path.parent for number in numbers[-2:])
    with pytest.raises(KeyError):
        uploads[numbers[0]]


def test_files_that_are_still_coming_count(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_LARGEST_SUM", 10)
    uploads = Uploads(tmp_path)
    opened = add(uploads, "old.csv", b"1234")

    async def give() -> list[int | BaseException]:
        async def content(size: int):
            for _ in range(size):
                yield b"x"
                # The others come as far.
                await asyncio.sleep(0)

        files = (uploads.add("a.csv", content(size)) for size in (4, 4, 4))
        return await asyncio.gather(*files, return_exceptions=True)

    given = asyncio.run(give())
    # The one from before made room, and of the three that came together two had it.
    with pytest.raises(KeyError):
        uploads[opened]
    taken = [each for each in given if isinstance(each, int)]
    assert [each.key for each in given if isinstance(each, InputError)] == ["a.csv"]
    assert [uploads[number].bytes for number in taken] == [4, 4]
    assert len(list(tmp_path.iterdir())) == 2
    # What was given up counts no longer, and neither does what was dropped.
    assert uploads[add(uploads, "b.csv", b"x" * 10)].bytes == 10


def test_as_many_files_as_are_kept_may_come(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_MOST_FILES", 2)
    uploads = Uploads(tmp_path)
    numbers = [add(uploads, "a.csv") for _ in range(3)]
    assert sorted(tmp_path.iterdir()) == sorted(uploads[number].path.parent for number in numbers[1:])


def test_the_studio_takes_bytes_there_and_json_elsewhere(client):
    assert client.post("/api/uploads?name=a.csv", content=b"1", headers=SENT).json()["name"] == "a.csv"
    assert client.post("/api/uploads?name=../a", content=b"1", headers=SENT).status_code == 422
    assert client.post("/api/uploads?name=a.csv", json={}, headers={"Origin": HOME}).status_code == 415
    assert client.post("/api/quick", content=b"1", headers=SENT).status_code == 415


def test_a_job_of_files_that_are_not_there_is_refused(client):
    origin = {"Origin": HOME}
    answer = client.post("/api/jobs/burn", json={}, headers=origin)
    assert answer.status_code == 422
    assert "unknown kind of job" in answer.text
    assert client.get("/api/jobs/7").status_code == 404
    assert client.get("/files/7/..%2f..%2fetc%2fpasswd").status_code == 404
    assert client.post("/api/jobs/7/cancel", json={}, headers=origin).status_code == 404
