"""A sweep that is killed, torn or damaged goes on and ends with the bytes of an undisturbed one."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys

import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import ComputationError, InputError
from pneutouch.workflows.sweep import journal, sweep
from pneutouch.workflows.sweep.journal import Journal
from pneutouch.workflows.sweep.work import chunks, study
from tests.running import in_new_process
from tests.workflows.sweep.conftest import (
    ALONE,
    POINTS,
    ended,
    held,
    journal_lines,
    load,
    names,
    resumed,
    six,
    small,
    stopped,
)


@pytest.mark.slow
def test_three_kills_at_random_moments_change_no_byte(undisturbed, tmp_path):
    out, luck, kept = tmp_path / "sweep.nc", random.Random(20261121), 0
    for workers in (2, 1, 2):
        chunks = luck.randint(1, 2)
        process = held(out, "--workers", str(workers), after=chunks)
        children = psutil.Process(process.pid).children(recursive=True)
        process.kill()
        assert ended(process)[0] == -signal.SIGKILL
        # Returns when all have ended: workers that outlived their parent would be waited for.
        psutil.wait_procs(children)
        kept += chunks
        assert journal_lines(out) == kept
        assert not out.exists()
    done = resumed(out)
    assert done.returncode == 0, done.stderr
    assert POINTS - json.loads(done.stdout)["computed"] == 32 * kept
    assert out.read_bytes() == undisturbed
    assert [name for name in names(tmp_path) if "-over-" not in name] == [
        "sweep-manifest.json",
        "sweep.csv",
        "sweep.nc",
    ]


@pytest.mark.slow
def test_ctrl_c_says_how_to_go_on(undisturbed, tmp_path):
    out = tmp_path / "sweep.nc"
    process = held(out, "--workers", "1", group=True)
    os.killpg(process.pid, signal.SIGINT)
    code, stdout, stderr = ended(process)
    assert (code, stdout) == (130, "")
    assert stderr.splitlines()[-1].startswith("stopped by Ctrl-C; ")
    assert f"of {POINTS} points are done and kept in {out}.parts; the same command" in stderr
    assert "Traceback" not in stderr
    assert resumed(out).returncode == 0
    assert out.read_bytes() == undisturbed


KILLS = {
    "dataset half written": "journal.replace_whole = lambda fresh, target, write: (write(fresh), os.truncate(fresh, 900), die())",
    "dataset not renamed": "journal.replace_whole = lambda fresh, target, write: (write(fresh), die())",
    "dataset renamed": "journal.sync = lambda path: path.is_dir() and die()",
    "journal removed": "journal.WorkFolder._clear = die",
}


@pytest.mark.slow
@pytest.mark.parametrize("moment", KILLS)
def test_a_kill_within_the_last_writes_loses_nothing(moment, library, tmp_path, root):
    out, plain = tmp_path / "sweep.nc", tmp_path / "plain.nc"
    words = [
        "sweep",
        "--design",
        "paper-dome",
        "--over",
        "membrane.wall_thickness_mm=0.5,0.9,1.5",
        "--model",
        "membrane",
    ]
    sweep(small(), plain, ALONE, library=library)
    code = (
        f"import os, sys; sys.argv = ['pneutouch', *{words!r}, '--out', {str(out)!r}, '--workers', '1']\n"
        "from pneutouch.workflows.sweep import journal\ndef die(*_): os.kill(os.getpid(), 9)\n"
        f"{KILLS[moment]}\nfrom pneutouch.cli import run; run()"
    )
    killed = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, check=False)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    renamed = moment in ("dataset renamed", "journal removed")
    assert out.exists() == renamed
    outcome = sweep(small(), out, ALONE, library=library)
    assert outcome.computed == 0
    assert outcome.states == {"ok": 11, "refused": 1, "failed": 0}
    assert out.read_bytes() == plain.read_bytes()
    assert names(tmp_path) == ["plain.nc", "sweep.nc"]


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["torn", "flipped", "no newline", "garbage before", "emptied", "twice"])
def test_a_damaged_journal_is_computed_again_where_it_is_damaged(damage, single, library, tmp_path):
    sweep(six(), tmp_path / "plain.nc", ALONE, library=library)
    out = tmp_path / "sweep.nc"
    stopped(out, library, 4)
    journal = tmp_path / "sweep.nc.parts/journal"
    content = journal.read_bytes()
    middle = len(content) // 2
    damaged, kept = {
        "torn": (content[:-40], 3),
        "flipped": (content[:middle] + bytes([content[middle] ^ 4]) + content[middle + 1 :], 3),
        "no newline": (content[:-1], 4),
        "garbage before": (b"\x00\xff\n\n{}\n" + content, 4),
        "emptied": (b"", 0),
        "twice": (content + content, 4),
    }[damage]
    journal.write_bytes(damaged)
    assert sweep(six(), out, ALONE, library=library).computed == 6 - kept
    assert out.read_bytes() == (tmp_path / "plain.nc").read_bytes()
    assert names(tmp_path) == ["plain.nc", "sweep.nc"]


def records(count):
    return [
        {"point": k, "states": [{"status": "ok", "message": "ü" * k, "x": k / 3}], "values": {}} for k in range(count)
    ]


def read(journal):
    """Records by point, which the journal also gives again from the places that it names."""
    found, places = [], []
    journal.read(lambda records, place: (found.extend(records), places.append(place)))
    assert list(journal.at(places)) == found
    return {record["point"]: record for record in found}


def test_a_journal_cut_anywhere_gives_its_whole_lines_and_takes_new_ones(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "fsync", lambda handle: None)
    path, all_ = tmp_path / "journal", records(6)
    journal = Journal(path, "f" * 64)
    ends = [0]
    for start in (0, 2, 3):
        journal.append(all_[start : start + (2, 1, 1)[(0, 2, 3).index(start)]])
        ends.append(path.stat().st_size)
    content, before = path.read_bytes(), [0, 2, 3, 4]
    for cut in range(len(content) + 1):
        path.write_bytes(content[:cut])
        # A line that lacks its newline alone is whole.
        whole = max(n for end, n in zip(ends, before, strict=True) if max(end - 1, 0) <= cut)
        assert read(journal) == dict(enumerate(all_[:whole]))
        journal.append(all_[4:])
        assert read(journal) == dict(enumerate(all_[:whole])) | {4: all_[4], 5: all_[5]}


@given(st.lists(st.tuples(st.integers(0, 10**6), st.integers(1, 255)), min_size=1, max_size=5))
def test_no_flipped_byte_ever_becomes_a_figure(tmp_path_factory, flips):
    path, all_ = tmp_path_factory.mktemp("j") / "journal", records(5)
    journal = Journal(path, "f" * 64)
    for record in all_:
        journal.append([record])
    content = bytearray(path.read_bytes())
    for place, change in flips:
        content[place % len(content)] ^= change
    path.write_bytes(bytes(content))
    found = read(journal)
    assert all(all_[k] == record for k, record in found.items())
    assert len(found) >= 5 - 2 * len(flips)


def test_progress_of_other_inputs_is_refused_and_fresh_starts_over(single, library, tmp_path):
    out = tmp_path / "sweep.nc"
    stopped(out, library, 2)
    for other in (six(closure="printed"), six(model="solid"), small(), six(design="stiff-dome")):
        with pytest.raises(InputError, match=r"sweep\.nc\.parts: holds the progress of another sweep.*`fresh`"):
            sweep(other, out, ALONE, library=library)
    assert journal_lines(out) == 2
    assert sweep(six(closure="printed"), out, ALONE, library=library, fresh=True).computed == 6
    assert load(out).attrs["closure"] == "printed"


def test_a_changed_material_is_noticed(single, library, tmp_path, root):
    from pneutouch.catalogue import Library

    paths = tmp_path / "lab/printprofiles/materials/TangoPlus.toml"
    paths.parent.mkdir(parents=True)
    text = (root / "printprofiles/materials/TangoPlus.toml").read_text()
    paths.write_text(text)
    own = Library((tmp_path / "lab", root))
    stopped(tmp_path / "sweep.nc", own, 2)
    paths.write_text("# a comment changes nothing\n" + text)
    stopped(tmp_path / "sweep.nc", own, 3)
    paths.write_text(text.replace("[shear_modulus_MPa]\nvalue = ", "[shear_modulus_MPa]\nvalue = 1"))
    assert paths.read_text() != text
    with pytest.raises(InputError, match="a material"):
        sweep(six(), tmp_path / "sweep.nc", ALONE, library=own)


def test_a_full_disk_is_said_and_the_progress_kept(single, library, tmp_path, monkeypatch):
    out, original = tmp_path / "sweep.nc", Journal.append

    def full(self, batch):
        if batch[0]["point"] == 3:
            raise OSError(28, "No space left on device")
        original(self, batch)

    monkeypatch.setattr(Journal, "append", full)
    with pytest.raises(ComputationError, match=r"No space left on device\n3 of 6 points are done and kept in"):
        sweep(six(), out, ALONE, library=library)
    monkeypatch.undo()

    def nowhere(fresh, target, write):
        raise OSError(28, "No space left on device", str(fresh))

    monkeypatch.setattr(journal, "replace_whole", nowhere)
    with pytest.raises(ComputationError, match=r"No space left on device\n6 of 6 points are done"):
        sweep(six(), out, ALONE, library=library)
    monkeypatch.undo()
    assert sweep(six(), out, ALONE, library=library).computed == 0
    assert names(tmp_path) == ["sweep.nc"]


@pytest.mark.slow
def test_a_worker_that_dies_is_said_and_the_progress_kept(undisturbed, tmp_path):
    out = tmp_path / "sweep.nc"
    process = held(out, "--workers", "2")
    workers = [p for p in psutil.Process(process.pid).children() if "spawn_main" in " ".join(p.cmdline())]
    assert len(workers) == 2
    workers[0].kill()
    code, _, stderr = ended(process)
    assert code == 3
    assert "a worker process died" in stderr
    assert "Traceback" not in stderr
    assert resumed(out).returncode == 0
    assert out.read_bytes() == undisturbed


@pytest.mark.slow
def test_another_hash_seed_and_process_give_the_same_bytes(library, tmp_path):
    out = tmp_path / "again.nc"
    sweep(small(), tmp_path / "plain.nc", ALONE, library=library)
    over = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=0.5,0.9,1.5", "--model", "membrane"]
    done = in_new_process(["sweep", *over, "--out", str(out), "--workers", "1"], tmp_path, {"PYTHONHASHSEED": "7"})
    assert done.returncode == 0, done.stderr
    assert out.read_bytes() == (tmp_path / "plain.nc").read_bytes()


@pytest.mark.parametrize("missing", [[0], [31, 32], [5, 127, 128], list(range(300))])
def test_a_chunk_is_cut_alike_whatever_is_missing(missing, library):
    """Points that are answered together are the same ones in a sweep that goes on, so that its bytes are the same."""
    whole = study(small(["membrane.wall_thickness_mm=1:1.8:300"], model="atlas"), library)
    every = {chunk.points[0].index: chunk for chunk in chunks(whole, list(range(300)))}
    assert sorted(point.index for chunk in every.values() for point in chunk.points) == list(range(300))
    for chunk in chunks(whole, missing):
        assert chunk == every[chunk.points[0].index]
    assert set(missing) <= {point.index for chunk in chunks(whole, missing) for point in chunk.points}
