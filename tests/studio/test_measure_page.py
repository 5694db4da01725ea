"""The area Measure in the browser: a campaign given, its figures those of the commands, a calibration saved and used."""

from __future__ import annotations

import json
import shutil
import zipfile

import pytest

from pneutouch.catalogue.library import HOME
from tests.bench.rig import small, write
from tests.browser import until
from tests.studio.access import violations
from tests.studio.campaigns import NAME, SENSOR, simulated
from tests.studio.served import Studio, served, solved
from tests.tables.instruments import excel, parquet, tdms

_AREA = "document.getElementById('area-measure')"
_CELLS = "[...document.querySelectorAll('{} tbody tr')].map(e => [...e.children].map(c => c.textContent.trim()))"


@pytest.fixture(scope="module")
def campaign(tmp_path_factory, library):
    return simulated(tmp_path_factory.mktemp("made"), library)


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """The user's folder of the commands and of `own`."""
    monkeypatch.setenv(HOME, str(tmp_path / "mine"))
    return tmp_path / "mine"


@pytest.fixture
def own(mine):
    """A studio whose user's folder is `mine`."""
    with served() as (address, process):
        yield Studio(address, process)


def opened(page):
    page.get_by_role("tab", name="Measure").click()
    until(page, "document.getElementById('measure-status')")
    return page


def given(page, folder):
    page.locator("#measure-folder").set_input_files(folder)
    until(page, f"{_AREA}.dataset.state === 'recognised' || document.querySelector('#measure-problems li')")


def did(page, state):
    until(page, f"{_AREA}.dataset.state === '{state}' || document.querySelector('#measure-problems li')")
    assert page.locator("#measure-problems li").all_text_contents() == []


def cells(page, selector):
    return page.evaluate(_CELLS.format(selector))


def short(value, digits=4):
    return float(f"{value:.{digits}g}")


def ends(text):
    return [float(end) for end in text.split(" to ")]


@pytest.mark.slow
def test_files_that_are_dropped_are_recognised(tmp_path, open_studio):
    page = opened(open_studio())
    page.evaluate(
        "text => { const transfer = new DataTransfer(); transfer.items.add(new File([text], 'Prüfung 1.csv'));"
        "const at = document.querySelector('.drop');"
        "for (const kind of ['dragover', 'drop'])"
        " at.dispatchEvent(new DragEvent(kind, { bubbles: true, cancelable: true, dataTransfer: transfer })); }",
        write(tmp_path / "run.csv", small(rate=25.0, depths=(1.0, 3.0))).read_text(),
    )
    until(page, f"{_AREA}.dataset.state === 'recognised'")
    assert cells(page, "#measure-columns") == [
        ["Prüfung 1.csv", "time_s s", "position_mm mm", "force_N N", "pressure_kPa kPa", ""]
    ]
    assert page.get_by_label("driving pressure in kPa of Prüfung 1.csv").input_value() == "12"
    assert violations(page) == []
    page.get_by_role("button", name="turn the sign of the force").click()
    until(page, "document.querySelector('#measure-columns td:nth-child(4)').textContent === '−force_N N'")
    page.get_by_label("unit of the position").select_option("um")
    until(page, "document.querySelector('#measure-columns td:nth-child(3)').textContent === 'position_mm um'")
    stated = "time=time_s:s, position=position_mm:um, force=-force_N:N, pressure=pressure_kPa:kPa"
    assert page.locator("[name=columns]").input_value() == stated
    page.get_by_role("button", name="Clear").click()
    assert page.locator("#measure-files").text_content() == "No files yet."
    assert page.get_by_role("button", name="Characterize").is_disabled()


@pytest.mark.slow
def test_figures_calibration_and_design_are_those_of_the_commands(campaign, own, mine, tmp_path, pages, command):
    page = opened(own.open(pages))
    given(page, campaign)
    shutil.copytree(campaign, tmp_path / NAME)
    page.get_by_role("button", name="Characterize").click()
    did(page, "measured")
    document = json.loads(command("characterize", NAME, "--design", "paper-dome", "--json").stdout)
    for place, group in enumerate(document["groups"]):
        table = f"section[aria-labelledby=measured-title-{place}] table.figures"
        keys = page.evaluate(f"[...document.querySelectorAll('{table} tbody tr')].map(e => e.dataset.key)")
        assert sorted(keys) == sorted(group["figures"])
        for row, key in zip(cells(page, table), keys, strict=True):
            figure = group["figures"][key]
            assert float(row[1]) == short(figure["value"])
            assert row[2] == "–" or ends(row[2]) == [short(figure["low"]), short(figure["high"])]
            predicted = figure.get("predicted")
            assert row[3] == ("" if predicted is None else row[3])
            if predicted is not None:
                assert float(row[3]) == short(predicted["value"])
        assert page.locator(f"#measured-rise-{place} canvas, #measured-force-{place} canvas").count() == 2
    assert [row[6] for row in cells(page, "table.figures") if row[0].startswith("Sensitivity, line with")] == [
        "2.547",
        "1.923",
    ]
    sheet = page.frame_locator("iframe[title='Measured sheet']")
    assert "Simulated campaign of paper-dome" in sheet.locator("h1").first.text_content()
    assert violations(page) == []
    with page.expect_download() as download:
        page.get_by_role("link", name="all files, zip").click()
    with zipfile.ZipFile(download.value.path()) as archive:
        written = tmp_path / document["folder"]
        names = {f"{written.name}/{path.relative_to(written)}" for path in written.rglob("*") if path.is_file()}
        assert set(archive.namelist()) == names
        assert archive.read(f"{written.name}/figures.json") == (written / "figures.json").read_bytes()

    page.get_by_label("22", exact=True).check()
    page.get_by_role("button", name="Calibrate").click()
    did(page, "calibrated")
    assert not mine.exists()
    words = ["calibrate", NAME, "--design", "paper-dome", "--sensor", SENSOR, "--hold-out", "22", "--save", "elsewhere"]
    fitted = json.loads(command(*words, "--json").stdout)
    shutil.rmtree(mine)
    for row, one in zip(cells(page, "#fitted"), fitted["estimates"], strict=True):
        assert float(row[1]) == short(one["value"])
        interval = one["interval_95"]
        assert row[2] == ("on its bound, no interval" if interval is None else row[2])
        assert interval is None or ends(row[2]) == [short(end) for end in interval]
    held = [float(text) for text in cells(page, "#held-out")[0][:3]]
    (expected,) = fitted["held_out"]
    assert held == [22, *(short(expected[f"sensitivity_{kind}_kPa_per_N"]) for kind in ("predicted", "measured"))]
    for note in fitted["notes"]:
        assert page.get_by_text(note, exact=True).count() == 1
    assert violations(page) == []

    page.get_by_label("Save calibration as").fill("mine-22")
    page.get_by_role("button", name="Save").click()
    did(page, "saved")
    file = mine / "calibrations/mine-22.toml"
    assert file.is_file()
    page.get_by_role("button", name="Use it").click()
    solved(page, "#paper-dome&calibration=mine-22")
    said = json.loads(command("predict", "paper-dome@mine-22", "--json").stdout)
    shown = [float(row[1].split(" ")[0]) for row in cells(page, "#figures")]
    assert shown == [short(state["sensitivity_kPa_per_N"]) for state in said["states"]]

    before = file.read_bytes()
    page.get_by_role("tab", name="Measure").click()
    page.get_by_label("wall", exact=True).uncheck()
    page.get_by_role("button", name="Calibrate").click()
    did(page, "calibrated")
    page.get_by_label("Save calibration as").fill("mine-22")
    page.get_by_role("button", name="Save").click()
    until(page, "document.getElementById('fitting-wrong').textContent")
    assert "there is a calibration of this name, of other content" in page.locator("#fitting-wrong").text_content()
    assert file.read_bytes() == before
    page.get_by_label("Replace the one of this name").check()
    page.get_by_role("button", name="Save").click()
    did(page, "saved")
    assert file.read_bytes() != before


def hostile(folder):
    """Files that are cut, damaged, made to harm or no runs, and what has to be said of each."""
    samples = small(rate=25.0, depths=(1.0, 3.0))
    instruments = (*samples[:3], 1e3 * samples[3])
    good = write(folder / "good.csv", samples)
    lines = good.read_text().splitlines(keepends=True)
    says = {}

    def add(name, content, words):
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        says[name] = words

    add("empty.csv", b"", "empty file")
    add("binary.csv", bytes(range(256)) * 50, "binary")
    add("cut.csv", good.read_bytes()[:-9], "cut off")
    add("word.csv", "".join([*lines[:50], "0.1,abc,1,2\n", *lines[50:]]), "'abc' is no finite number")
    add("huge.csv", "".join([*lines[:50], "1e400,1,1,1\n", *lines[50:]]), "row 51")
    add("columns.csv", "".join(lines).replace("force_N", "Moment_Nm"), "no column of force")
    add("markup.csv", "<script>alert(1)</script>,b\n1,2\n", "no column of")
    add("formula.csv", "=cmd|' /C calc'!A0,b\n1,2\n", "no column of")
    for make, words in ((excel, "no whole Excel file"), (tdms, ""), (parquet, "")):
        path = make(folder, *instruments)
        add(path.name, path.read_bytes()[:700], words)
    with zipfile.ZipFile(excel(folder, *instruments), "a", zipfile.ZIP_DEFLATED) as book:
        book.writestr("xl/media/image1.png", bytes(110_000_000))
    (folder / "excel.xlsx").rename(folder / "bomb.xlsx")
    says["bomb.xlsx"] = "MB unpacked"
    add("excel.xlsx", (folder / "bomb.xlsx").read_bytes()[:700], "no whole Excel file")
    write(folder / "dead.csv", samples * [[1.0], [1.0], [0.0], [1.0]])
    says["dead.csv"] = "force_N"
    return says


@pytest.mark.slow
def test_each_hostile_file_is_named_with_its_reason_and_the_studio_lives(tmp_path, open_studio):
    (tmp_path / "lab").mkdir()
    says = hostile(tmp_path / "lab")
    page = opened(open_studio())
    given(page, tmp_path / "lab")
    found = {
        row[0]: row[1]
        for row in page.evaluate(
            "[...document.querySelectorAll('#area-measure .finding.error')].map(e =>"
            "[e.children[0].textContent.replace('not used ', ''), e.children[1].textContent])"
        )
    }
    assert set(found) == set(says)
    for name, words in says.items():
        assert found[name].startswith(f"lab/{name}: ")
        assert words in found[name]
        assert "internal fault" not in found[name]
    assert page.locator("#area-measure script").count() == 0
    assert violations(page) == []
    page.get_by_role("tab", name="Design").click()
    solved(page, "#paper-dome")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\xff\xfe\0", "campaign.toml"),
        (b"a = " + b"[" * 50_000, "campaign.toml"),
        (b"[[runs]]\nfile = 7", "campaign.toml: runs[0].file = 7: must be text"),
        (b'[[runs]]\nfile = "../../../../etc/passwd"\nsensor = "a"\nresin = "TangoPlus"', "leads out of the folder"),
        (b'design = "/etc/passwd"\n[[runs]]\nfile = "a.csv"\nsensor = "a"\nresin = "TangoPlus"', "leads out of"),
        (b"x = 1\n" * 400_000, "larger than"),
    ],
)
def test_a_hostile_campaign_file_is_refused_in_the_words_of_the_command(content, words, tmp_path, open_studio):
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab/campaign.toml").write_bytes(content)
    write(tmp_path / "lab/a.csv", small(rate=25.0, depths=(1.0, 3.0)))
    page = opened(open_studio())
    given(page, tmp_path / "lab")
    if not page.locator("#measure-problems li").count():
        page.get_by_label("Compare with").select_option("campaign")
        page.get_by_role("button", name="Characterize").click()
        until(page, "document.querySelector('#measure-problems li')")
    problem = page.locator("#measure-problems li").text_content()
    assert words in problem
    assert problem.startswith("lab")
    assert "internal fault" not in problem


@pytest.mark.slow
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [360, 2560])
def test_the_area_fits_every_width(width, dark, campaign, open_studio):
    page = opened(open_studio(width=width, dark=dark, is_mobile=width < 600))
    given(page, campaign)
    page.get_by_text("How files are read").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert violations(page) == []
