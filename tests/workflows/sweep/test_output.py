"""What lies at the output and beside it: finished datasets, others' files, locks of the living and the dead."""

from __future__ import annotations

import tracemalloc

import pytest

from pneutouch.errors import ComputationError, InputError
from pneutouch.workflows.sweep import dataset, execute, plan_of_file, sweep, work
from pneutouch.workflows.sweep.dataset import stored_dataset, table_rows
from tests.refusals import refused
from tests.workflows.sweep.conftest import ALONE, ended, held, names, resumed, six, small


def test_a_finished_dataset_is_kept_and_no_other_is_overwritten(library, tmp_path):
    out = tmp_path / "sweep.nc"
    sweep(small(), out, ALONE, library=library)
    content, changed = out.read_bytes(), out.stat().st_mtime_ns
    assert sweep(small(), out, ALONE, library=library).computed == 0
    with refused("out"):
        sweep(six(), out, ALONE, library=library)
    assert (out.read_bytes(), out.stat().st_mtime_ns) == (content, changed)
    assert sweep(small(), out, ALONE, library=library, fresh=True).computed == 3
    assert out.read_bytes() == content
    assert sweep(six(), out, ALONE, library=library, fresh=True).computed == 6
    assert names(tmp_path) == ["sweep.nc"]


def test_a_file_that_is_no_whole_dataset_is_refused_and_left(library, tmp_path):
    out = tmp_path / "sweep.nc"
    sweep(small(), out, ALONE, library=library)
    whole = out.read_bytes()
    for content in (b"", b"my notes", whole[:40], whole[: len(whole) // 2], whole[:-9]):
        out.write_bytes(content)
        for fresh in (False, True):
            with pytest.raises(InputError, match=r"sweep\.nc"):
                sweep(small(), out, ALONE, library=library, fresh=fresh)
        assert out.read_bytes() == content
        assert names(tmp_path) == ["sweep.nc"]


def test_a_stopped_replacement_goes_on_and_the_old_dataset_stays_until_then(single, library, tmp_path):
    out = tmp_path / "sweep.nc"
    sweep(small(), out, ALONE, library=library)
    content = out.read_bytes()

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep(six(), out, ALONE, library=library, fresh=True, progress=stop)
    assert out.read_bytes() == content
    assert sweep(six(), out, ALONE, library=library).computed == 4
    assert out.read_bytes() != content


@pytest.mark.parametrize("states", [1, 7, 40])
def test_a_dataset_written_and_read_in_parts_is_the_whole_one(states, library, tmp_path, monkeypatch):
    """Texts of other lengths in each part, names along the first field, points with other driving pressures."""
    walls, resins = "membrane.wall_thickness_mm=0.3,1.2,1.5", "membrane.material=TangoPlus,FLX9950"
    grids = [small([resins, walls, "membrane.inner_radius_mm=3,9"]), small([walls, resins])]
    content = 'design = "paper-dome"\nmodel = "membrane"\n'
    for wall, pressures in ((0.4, [5]), (1.5, [0, 22]), (1.2, [5, 22])):
        content += f"[[point]]\nmembrane.wall_thickness_mm = {wall}\n"
        content += f"pneumatics.driving_pressures_kPa = {pressures}\n"
    (tmp_path / "list.toml").write_text(content)
    for k, plan in enumerate([*grids, plan_of_file(tmp_path / "list.toml")]):
        whole, parts = tmp_path / f"whole-{k}.nc", tmp_path / f"parts-{k}.nc"
        monkeypatch.setattr(dataset, "_STATES", 10**6)
        sweep(plan, whole, ALONE, library=library)
        rows = list(table_rows(stored_dataset(whole)))
        assert len(rows) == sum(sweep(plan, whole, ALONE, library=library).states.values())
        monkeypatch.setattr(dataset, "_STATES", states)
        sweep(plan, parts, ALONE, library=library)
        assert parts.read_bytes() == whole.read_bytes()
        assert list(table_rows(stored_dataset(parts))) == rows


def test_a_title_of_zeros_is_no_place_for_the_hash(library, tmp_path):
    (tmp_path / "zeros.toml").write_text(f'[document]\ntitle = "{"0" * 64}"\n')
    plan, out = small(design=str(tmp_path / "zeros.toml")), tmp_path / "sweep.nc"
    sweep(plan, out, ALONE, library=library)
    assert "0" * 64 in stored_dataset(out).attrs["base_design_content"]
    assert sweep(plan, out, ALONE, library=library).computed == 0


def test_memory_for_a_dataset_does_not_grow_with_its_points(library, tmp_path, monkeypatch):
    """Three times the points, with the records of some: the peak of what Python allocates is that of a few parts."""
    base = sweep_records(library, tmp_path)
    peaks = []

    def repeated(machines, folder, points):
        for chunk in work.chunks(points.study, points.missing):
            yield [{**base[point.index % len(base)], "point": point.index} for point in chunk.points]

    def measured(points, journal, path):
        tracemalloc.start()
        dataset.write_dataset(points, journal, path)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()

    monkeypatch.setattr(execute, "_batches", repeated)
    monkeypatch.setattr(execute, "write_dataset", measured)
    monkeypatch.setattr(dataset, "_STATES", 400)
    for count in (3000, 9000):
        plan = small([f"membrane.wall_thickness_mm=1:1.5:{count}"])
        sweep(plan, tmp_path / f"{count}.nc", ALONE, library=library)
    assert peaks[1] < 1.2 * peaks[0]


def sweep_records(library, folder):
    """Records of a few points, as a sweep keeps them."""
    found = work.study(small(["membrane.wall_thickness_mm=1:1.5:10"]), library)
    work.unpack(found.files, folder / "inputs")
    return [record for chunk in work.chunks(found, range(10)) for record in work.compute(chunk, folder / "inputs")]


def test_a_journal_that_changes_while_a_dataset_is_written_is_no_result(single, library, tmp_path):
    out = tmp_path / "sweep.nc"

    def damage(done, total):
        if done == total:
            path = tmp_path / "sweep.nc.parts" / "journal"
            path.write_bytes(path.read_bytes().replace(b'"ok"', b'"no"', 1))

    with pytest.raises(ComputationError, match="journal"):
        sweep(six(), out, ALONE, library=library, progress=damage)
    assert names(tmp_path) == ["sweep.nc.parts"]
    assert sweep(six(), out, ALONE, library=library).computed == 1


@pytest.mark.slow
def test_two_sweeps_on_one_output_are_one_too_many(undisturbed, tmp_path):
    out = tmp_path / "sweep.nc"
    first = held(out, "--workers", "1")
    second = resumed(out)
    assert (second.returncode, second.stdout) == (2, "")
    assert f"--out: {out}: process {first.pid} is sweeping into it" in second.stderr
    assert ended(first)[0] == 0
    assert out.read_bytes() == undisturbed


def test_a_lock_file_of_a_dead_process_holds_nobody(library, tmp_path):
    (tmp_path / "sweep.nc.parts").mkdir()
    (tmp_path / "sweep.nc.parts/lock").write_text("1\n")
    sweep(small(), tmp_path / "sweep.nc", ALONE, library=library)
    assert names(tmp_path) == ["sweep.nc"]


def test_a_folder_of_another_program_is_left_alone(library, tmp_path):
    (tmp_path / "sweep.nc.parts").mkdir()
    (tmp_path / "sweep.nc.parts/thesis.tex").write_text("mine")
    with refused(None, file=tmp_path / "sweep.nc.parts/thesis.tex"):
        sweep(small(), tmp_path / "sweep.nc", ALONE, library=library)
    assert names(tmp_path / "sweep.nc.parts") == ["thesis.tex"]
