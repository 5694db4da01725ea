"""How a sensor is made: a cast one by weighing, pouring and curing, a printed one as before."""

import re

import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.export import templates
from pneutouch.parts import assemble
from pneutouch.parts.mould import silicone_batch
from pneutouch.report import section
from pneutouch.report.pages import TEMPLATES
from pneutouch.report.print_sheet import making, making_title
from tests.conftest import ROOT
from tests.report.overlaps import overlaps


def steps(name, changes=None):
    assembly = assemble(load_scene(name, changes))
    pour = None if assembly.mould is None else silicone_batch(assembly.mould)
    return pour, making(assembly, pour)


def test_a_cast_dome_is_weighed_by_its_ratio_poured_cured_and_peeled():
    pour, lines = steps("cast-dome")
    assert pour.parts_g == pytest.approx((pour.mass_g / 2, pour.mass_g / 2))
    text = " ".join(lines)
    assert f"{pour.parts_g[0]:.2f} g of part A and {pour.parts_g[1]:.2f} g of part B" in text
    order = [
        text.index(word) for word in ("Release agent", "Weigh", "Degas", "Pour", "Curing: 4 h", "Demould", "screws")
    ]
    assert order == sorted(order)
    assert "latex" in text and "water jet" not in text and "Aim the jet" not in text and "support" not in lines[0]
    assert making_title(pour) == "How to make it"


@pytest.mark.parametrize(
    ("pressures", "rated", "tested"), [([0, 22], 19.7, 19.7), ([0, 12], 19.7, 12), ([-12, -3], 19.7, 12), ([0], 9, 1)]
)
def test_leaks_are_looked_for_at_the_lesser_of_stated_and_rated_pressure(pressures, rated, tested):
    assembly = assemble(load_scene("paper-dome", {"pneumatics.driving_pressures_kPa": pressures}))
    lines = making(assembly, rated_kPa=rated)
    (line,) = (text for text in lines if text.startswith("Airtightness"))
    assert re.findall(r"[\d.]+(?= kPa)", line) == [f"{tested:g}"]


def test_a_ring_is_printed_put_into_the_mould_cast_around_and_glued():
    _, lines = steps("cast-dome", {"connector.seat": "cast-ring", "mould.cavities": 4})
    text = " ".join(lines)
    order = [
        text.index(word) for word in ("make 4", "degrease", "into the mould's ring", "Pour", "straight off", "epoxy")
    ]
    assert order == sorted(order)
    assert "peel the flange" not in text and "0.40 mm a side" in text


def test_a_printed_dome_has_nothing_to_pour():
    pour, lines = steps("paper-dome")
    assert pour is None and making_title(pour) == "Material and print"
    assert "flexible adhesive that wets both materials" in " ".join(lines) and "Weigh" not in " ".join(lines)


@pytest.mark.parametrize(
    ("name", "changes", "glue"),
    [
        ("cast-dome", {"connector.seat": "glued-flange"}, "silicone adhesive (such as Sil-Poxy)"),
        ("paper-dome", {"connector.glue": "cyanoacrylate"}, "cyanoacrylate"),
    ],
)
def test_the_glue_is_that_of_the_pair_of_materials(name, changes, glue):
    _, lines = steps(name, changes)
    assert f"Lay a bead of {glue} around the spigot" in " ".join(lines)


SOFT = """title = "Own elastomer"
code = "OE"
kind = "elastomer"
base_resins = ["OwnSoft"]
colour = "#7FB4D6"
density_g_per_cm3 = { value = 1.1, source = "made up for a test" }
poisson_ratio = { value = 0.49, source = "made up for a test" }
shear_modulus_MPa = { value = 0.7, source = "made up for a test" }
"""

SHIPPED = {"filament": "abs-filament", "resin": "sla-resin"}

POLYJET = re.compile(r"\bjets?\b|gloss|matte|GrabCAD|support gel|SUP70|lamps", re.IGNORECASE)
"""Words that hold for PolyJet alone."""


def printed(process, folder, changes=None, facts=""):
    """Steps of a dome and a connector, both made by a process on a profile of the laboratory's own."""
    materials = folder / "printprofiles" / "materials"
    materials.mkdir(parents=True)
    (materials / "OwnSoft.toml").write_text(SOFT + facts)
    text = (ROOT / "printprofiles" / f"{SHIPPED[process]}.toml").read_text()
    rigid = "ABS" if process == "filament" else "ClearResin"
    (folder / "printprofiles" / "own.toml").write_text(text.replace(f'["{rigid}"]', f'["OwnSoft", "{rigid}"]'))
    made = {"print.profile": "own", "print.connector_profile": "own", "connector.material": rigid}
    made = {**made, "membrane.material": "OwnSoft", **(changes or {})}
    return making(assemble(load_scene("paper-dome", made, Library((folder, ROOT)))))


@pytest.mark.parametrize("orientation", ["dome-up", "dome-down"])
@pytest.mark.parametrize("seat", ["glued-flange", "clamped-flange-M2"])
@pytest.mark.parametrize("process", SHIPPED)
def test_a_part_is_told_what_its_own_process_asks_for(tmp_path, process, seat, orientation):
    lines = printed(process, tmp_path, {"connector.seat": seat, "print.orientation": orientation})
    assert not [line for line in lines if POLYJET.search(line)]
    for part in ("Membrane", "Connector"):
        line = next(line for line in lines if line.startswith(f"{part}:"))
        places = [line.index(word) for word in ("Support:", "Cleaning:", "Curing:")]
        # A resin is washed before its supports come off, and cured last.
        order = places if process == "filament" else [places[k] for k in (1, 0, 2)]
        assert order == sorted(order)
    tight = next(line for line in lines if line.startswith("Airtightness:"))
    assert ("under water" in tight) == (process == "filament")


def test_polyjet_keeps_its_jet_and_its_face_without_support():
    _, lines = steps("paper-dome", {"connector.material": "VeroClear", "print.connector_profile": "objet260-connex"})
    assert len([line for line in lines if POLYJET.search(line)]) == 2


@pytest.mark.parametrize(("process", "key"), [("filament", "settings"), ("resin", "cleaning"), ("resin", "curing")])
def test_a_fact_of_the_material_is_on_the_sheet_and_a_missing_one_is_named(tmp_path, process, key):
    (tmp_path / "with").mkdir()
    (tmp_path / "without").mkdir()
    fact = "so and so much for seven minutes"
    facts = f'[making]\n{key} = "{fact}"\nsource = "made up for a test"\n'
    stated = " ".join(printed(process, tmp_path / "with", facts=facts))
    missing = " ".join(printed(process, tmp_path / "without"))
    assert fact in stated and f"(making.{key})" in missing
    # The connector's own material states nothing, and its sheet says so.
    assert stated.count(f"(making.{key})") == missing.count(f"(making.{key})") - 1


@pytest.mark.parametrize("name", sorted(Library((ROOT,)).all("ports", object)))
def test_a_hole_for_a_thread_states_its_tap_drill(name):
    port = load_scene("paper-dome", {"connector.port": name}).port
    _, lines = steps("paper-dome", {"connector.port": name})
    text = next(line for line in lines if line.startswith("Drilling"))
    if port.family == "thread":
        diameter, pitch = (float(part) for part in port.thread.removeprefix("M").split(" x "))
        # ISO 2306: the tap drill of a coarse thread is its diameter less its pitch.
        assert port.core_diameter == pytest.approx(diameter - pitch)
        assert f"{port.core_diameter:g} mm" in text and f"tap {port.thread}" in text


def test_a_mix_is_printed_from_its_stack_and_a_digital_material_by_its_code():
    _, mixed = steps("graded-dome")
    assert not [line for line in mixed if line.startswith("Digital material:")]
    assert any("--voxels" in line and "graded-dome-voxels" in line for line in mixed)
    _, coded = steps("fingertip-dome")
    assert any("FLX9940" in line for line in coded) and not any("--voxels" in line for line in coded)


@pytest.mark.parametrize("mount", sorted(Library((ROOT,)).all("mounts", object)))
@pytest.mark.parametrize("port", ["barb-4x2.5", "push-in-4", "thread-M5", "luer-female"])
def test_every_drill_and_tap_of_the_steps_is_among_the_tools(port, mount):
    changes = {"connector.port": port, "connector.mount": mount, "connector.seat": "clamped-flange-M2"}
    assembly = assemble(load_scene("cast-dome", changes))
    lines = making(assembly, silicone_batch(assembly.mould))
    line = next(line for line in lines if line.startswith("Drilling"))
    hardware = templates(TEMPLATES, autoescape=False).get_template("hardware.j2").make_module({"scene": assembly.scene})
    drilled = {float(size) for size in re.findall(r"to ([\d.]+) mm", line)}
    assert drilled == set(hardware.drills)
    tapped = set(re.findall(r"tap (M\d+(?: x \d\.\d+)?)", line))
    assert tapped == set(hardware.taps)
    # The screw's thread fits into its blind hole, and is at least its own diameter long in it.
    seat = assembly.scene.seat
    grip = seat.ring_thickness + (1 - seat.squeeze) * assembly.layout.flange_thickness
    assert 2.0 <= hardware.screw_mm - grip <= seat.core_depth


def test_the_leak_that_is_allowed_is_a_hundredth_of_the_range(evaluated):
    evaluation = evaluated("paper-dome", model="membrane")
    state = evaluation.prediction.states[-1]
    (line,) = (text for text in making(evaluation.assembly, state=state) if text.startswith("Airtightness"))
    fall_kPa, force_N = (float(text) for text in re.findall(r"([\d.]+) (?:kPa a minute|N\b)", line))
    assert force_N == pytest.approx(0.01 * state.figures.force_high, rel=0.05)
    assert fall_kPa == pytest.approx(force_N * state.figures.sensitivity, rel=0.06)


ONE_PIECE = {"seat": "one-piece", "material": "VeroClear", "mount": "robot-50-4-M6", "port": "luer-female"}
PUT_TOGETHER = {
    "glued": ("paper-dome", {}),
    "clamped": ("cast-dome", {"mount": "rear-3xM2", "port": "push-in-4"}),
    "cast around a ring": ("cast-dome", {"seat": "cast-ring", "mount": "finger-16", "port": "thread-M5"}),
    "one piece": ("paper-dome", ONE_PIECE),
    "plain": ("paper-dome", {"mount": "plain"}),
    "gasket": ("paper-dome", {"seat": "clamped-flange-M2-gasket", "port": "o-ring-9", "mount": "rear-4xM3-insert"}),
    "inserts": ("cast-dome", {"seat": "clamped-flange-M2-insert", "port": "o-ring-9", "mount": "finger-16"}),
}


@pytest.mark.parametrize("kind", PUT_TOGETHER)
def test_each_step_that_joins_parts_has_a_picture_under_its_number_at_one_scale(kind, monkeypatch):
    name, parts = PUT_TOGETHER[kind]
    changes = {f"connector.{key}": value for key, value in parts.items()}
    if kind == "one piece":
        changes["print.connector_profile"] = "objet260-connex"
    _, lines = steps(name, changes)
    assembly, drawn = assemble(load_scene(name, changes)), []
    with overlaps() as (found, _):
        section.assembly_pictures(assembly, lines)
    assert found == []
    monkeypatch.setattr(section, "svg", lambda figure: drawn.append(figure) or "")
    section.assembly_pictures(assembly, lines)
    heads = ("Joining", "Port", "Mount", "Airtightness")
    expected = [f"{k} {text.split(':')[0]}" for k, text in enumerate(lines, 1) if text.split(":")[0] in heads]
    axes = drawn[0].axes
    assert [ax.get_title() for ax in axes] == expected and len(expected) == 4 - (kind == "plain")
    assert len({round(float(ax.viewLim.width), 9) for ax in axes}) == 1
    for ax in axes:
        assert ax.viewLim.containsx(ax.dataLim.x0) and ax.viewLim.containsx(ax.dataLim.x1)
        assert ax.viewLim.containsy(ax.dataLim.y0) and ax.viewLim.containsy(ax.dataLim.y1)
