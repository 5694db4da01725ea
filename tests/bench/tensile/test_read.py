"""Tensile files as labs have them: columns and units found, and the usual mistakes refused in words."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import curve_fit

from pneutouch.bench.tensile.choose import PuckSize, fit_puck
from pneutouch.bench.tensile.law_fit import tension
from pneutouch.bench.tensile.read import SpecimenSize, _size, read_tension
from pneutouch.errors import InputError

LAMBDA = np.linspace(1.02, 3.0, 60)
STRESS = tension("yeoh", (0.06, 0.009), LAMBDA)


def write(folder, header, *columns, lines=(), delimiter=","):
    path = folder / "data.csv"
    rows = [delimiter.join(f"{value:.8g}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([*lines, header, *rows]) + "\n")
    return path


@pytest.mark.parametrize(
    ("header", "length", "load"),
    [
        ("stretch,stress (MPa)", LAMBDA, STRESS),
        ("Engineering Strain,Engineering Stress (kPa)", LAMBDA - 1, 1e3 * STRESS),
        ("strain (mm/mm),stress (MPa)", LAMBDA - 1, STRESS),
        ("strain (%),nominal stress [psi]", 100 * (LAMBDA - 1), STRESS / 6.894757e-3),
        ("True Strain,True Stress (MPa)", np.log(LAMBDA), STRESS * LAMBDA),
        ("Dehnung (%),Spannung (N/mm2)", 100 * (LAMBDA - 1), STRESS),
        ("Extension (mm),Load (N)", 25 * (LAMBDA - 1), 12 * STRESS),
        ("Extension_cm,Load_mN", 2.5 * (LAMBDA - 1), 12e3 * STRESS),
    ],
)
def test_columns_and_units(tmp_path, header, length, load):
    curve = read_tension(write(tmp_path, header, length, load), SpecimenSize(25, 6, 2))
    assert curve.stretch == pytest.approx(LAMBDA, rel=1e-6)
    assert curve.stress == pytest.approx(STRESS, rel=1e-5)


def test_the_kind_of_test_is_read_from_the_columns_or_given(tmp_path):
    named = write(tmp_path, "equibiaxial stretch,stress (MPa)", LAMBDA, STRESS)
    assert read_tension(named).kind == "equibiaxial"
    with pytest.raises(InputError) as caught:
        read_tension(named, kind="planar")
    assert caught.value.key == "kinds"
    assert read_tension(write(tmp_path, "stretch,stress (MPa)", LAMBDA, STRESS), kind="planar").kind == "planar"
    assert read_tension(write(tmp_path, "stretch,stress (MPa)", LAMBDA, STRESS)).kind == "tension"


@pytest.mark.parametrize(("radius", "within"), [(True, 1e-6), (False, 0.05)])
def test_an_inflated_disc_gives_the_stress_of_its_pole(tmp_path, radius, within):
    # Neo-Hookean membrane, mu 1 MPa, opening 2 mm, 0.01 mm thick, integrated from pole to rim: stretch and height.
    table = ((1.05, 0.2743), (1.1, 0.3828), (1.2, 0.5308), (1.4, 0.7246), (1.6, 0.8654), (1.8, 0.9808), (2.0, 1.0829))
    stretch, height = np.array(table).T
    curvature = (1 + height**2) / (2 * height) / np.interp(stretch, (1.05, 1.4, 1.6, 1.8, 2), PRESSED)
    nominal = stretch - stretch**-5
    pressure = 1e3 * 2 * 0.01 * nominal / (curvature * stretch)
    columns = [np.concatenate([[value], values]) for value, values in ((1.02, stretch), (1e-3, pressure))]
    bent = ("Radius (mm)", np.r_[curvature[0], curvature]) if radius else ("Height (mm)", np.r_[0.172, height])
    curve = read_tension(
        write(tmp_path, f"stretch,pressure (kPa),{bent[0]}", *columns, bent[1]), SpecimenSize(None, None, 0.01, 2)
    )
    assert curve.kind == "equibiaxial"
    assert curve.stress[-7:] == pytest.approx(nominal, rel=within)


PRESSED = (0.9078, 0.917, 0.9305, 0.9427, 0.9526)
"""Radius of a cap of the pole's height over the pole's, of that membrane at its stretches."""


def test_simple_shear_is_no_planar_tension(tmp_path):
    sheared = write(tmp_path, "Shear Strain,Shear Stress (MPa)", LAMBDA - 1, STRESS)
    refused(sheared, "planar")
    assert read_tension(sheared, kind="planar").kind == "planar"
    pure = write(tmp_path, "Pure Shear Strain,Stress (MPa)", LAMBDA - 1, STRESS)
    assert read_tension(pure).kind == "planar"


def test_an_inflated_disc_without_its_size_is_refused(tmp_path):
    path = write(tmp_path, "stretch,pressure (kPa),height (mm)", LAMBDA, STRESS, LAMBDA)
    for size in (SpecimenSize(), SpecimenSize(None, None, 1.0)):
        with pytest.raises(InputError) as caught:
            read_tension(path, size)
        assert "_mm" in str(caught.value.remedy)
    with pytest.raises(InputError):
        read_tension(write(tmp_path, "stretch,pressure (kPa)", LAMBDA, STRESS), SpecimenSize(None, None, 1.0, 20))


HEAD = (
    "PARAMETER;INFO;;;",
    "Specimen Length (mm);33;;;",
    "Speed (mm/min);450;;;",
    "Strain Measurement;Global;;;",
    ";;;;",
)
COLUMNS = "Time (s);True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)"


def test_the_size_that_a_file_states_is_taken_where_none_is_given():
    facts = {"Speed (mm/min)": "450", "Specimen Length (mm)": "33", "Width (mm)": "6.1", "Thickness": "2"}
    assert _size(None, facts) == SpecimenSize(33.0, 6.1, None)
    assert _size(SpecimenSize(25.0, None, 1.9), facts) == SpecimenSize(25.0, 6.1, 1.9)


def database(folder, blank=False, swapped=False):
    nominal = STRESS * LAMBDA if swapped else STRESS
    rows = [
        f"{k:g};{np.log(s):.8g};{p * s:.8g};" + (";" if blank else f"{s - 1:.8g};{n:.8g}")
        for k, (s, p, n) in enumerate(zip(LAMBDA, STRESS, nominal, strict=True))
    ]
    path = folder / "silicone.csv"
    path.write_text("\n".join([*HEAD, COLUMNS, *rows]) + "\n")
    return path


@pytest.mark.parametrize("blank", [False, True])
def test_the_files_of_the_soft_robotics_materials_database(tmp_path, blank):
    curve = read_tension(database(tmp_path, blank))
    assert curve.stress == pytest.approx(STRESS, rel=1e-5)
    assert curve.facts["Speed (mm/min)"] == "450"
    assert bool(curve.notes) == blank


def refused(path, match, **size):
    with pytest.raises(InputError, match=match):
        read_tension(path, SpecimenSize(**size))


def test_units_that_are_wrong(tmp_path):
    refused(write(tmp_path, "strain,stress (MPa)", 100 * (LAMBDA - 1), STRESS), "per cent")
    refused(write(tmp_path, "strain,stress (MPa)", LAMBDA - 1, 1e3 * STRESS), "in kPa and named MPa")
    refused(write(tmp_path, "strain,stress (kPa)", LAMBDA - 1, STRESS), "in MPa and named kPa")
    refused(write(tmp_path, "strain,stress", LAMBDA - 1, STRESS), "states no unit")
    refused(write(tmp_path, "stretch,stress (MPa)", LAMBDA - 1, STRESS), "is it a strain")
    refused(write(tmp_path, "strain,stress (MPa)", LAMBDA, STRESS), "is it a stretch")
    refused(write(tmp_path, "strain (%),stress (MPa)", LAMBDA - 1, STRESS), "largest stretch is 1.0")
    refused(write(tmp_path, "strain,true stress (MPa)", LAMBDA - 1, STRESS), "one is true")
    refused(write(tmp_path, "strain,stress (mm)", LAMBDA - 1, STRESS), "no unit of a stress")
    refused(write(tmp_path, "a,b", LAMBDA - 1, STRESS), "no columns of stretch and stress")


def test_true_and_engineering_columns_that_contradict(tmp_path):
    refused(database(tmp_path, swapped=True), "are the names exchanged")


def test_lengths_that_are_missing(tmp_path):
    path = write(tmp_path, "Extension (mm),Force (N)", 25 * (LAMBDA - 1), 12 * STRESS)
    refused(path, "gauge_length", width=6, thickness=2)
    refused(path, "cross-section", gauge_length=25)


def test_points_that_are_wrong(tmp_path):
    refused(write(tmp_path, "stretch,stress (MPa)", LAMBDA[:5], STRESS[:5]), "5 points")
    cyclic = np.concatenate([LAMBDA[:20], LAMBDA[:20][::-1], LAMBDA])
    stress = np.concatenate([STRESS[:20], STRESS[:20][::-1], STRESS])
    refused(write(tmp_path, "stretch,stress (MPa)", cyclic, stress), "the stretch falls")


def test_a_stress_recorded_as_negative(tmp_path):
    refused(write(tmp_path, "stretch,stress (MPa)", LAMBDA, -STRESS), "the stress that is greatest in size is")
    refused(write(tmp_path, "strain,stress (MPa)", 1 - LAMBDA, -STRESS), "turn the signs")
    noisy = STRESS - 0.01 * STRESS.max()
    assert read_tension(write(tmp_path, "stretch,stress (MPa)", LAMBDA, noisy)).stress.max() > 0


def test_points_after_the_break_are_left_out(tmp_path):
    stress = np.concatenate([STRESS[:50], np.zeros(10)])
    curve = read_tension(write(tmp_path, "stretch,stress (MPa)", LAMBDA, stress))
    assert curve.stretch[-1] == pytest.approx(LAMBDA[49])
    assert "after the greatest stress" in curve.notes[-1]


def test_of_a_loop_the_loading_counts(tmp_path):
    around, stress = np.concatenate([LAMBDA, LAMBDA[::-1]]), np.concatenate([STRESS, 0.8 * STRESS[::-1]])
    curve = read_tension(write(tmp_path, "stretch,stress (MPa)", around, stress))
    assert curve.stretch == pytest.approx(LAMBDA)
    assert curve.stress == pytest.approx(STRESS, rel=1e-6)


@pytest.mark.parametrize("bonded", [False, True])
def test_a_puck_gives_its_modulus(tmp_path, bonded):
    size, travel = PuckSize(20.0, 10.0, bonded), np.linspace(0.0, 3.0, 40)
    stretch = 1 - np.maximum(travel - 0.3, 0) / 10
    force = 0.2 * (stretch**-2 - stretch) * np.pi * 100 * (1.5 if bonded else 1.0)
    fit = fit_puck(write(tmp_path, "Compression (mm),Force (N)", travel, force), size)
    assert fit.modulus == pytest.approx(0.2, rel=0.01)
    assert fit.zero == pytest.approx(0.3, abs=0.02)
    assert 1.2 < fit.largest < 1.5


def test_the_error_of_a_puck_s_modulus_is_twice_that_of_least_squares(tmp_path):
    travel = np.linspace(0.0, 3.0, 9)
    stretch = 1 - travel / 10
    noise = np.random.default_rng(3).normal(0.0, 0.4, travel.size)
    force = 0.2 * (stretch**-2 - stretch) * np.pi * 100 + noise
    fit = fit_puck(write(tmp_path, "Compression (mm),Force (N)", travel, force), PuckSize(20.0, 10.0))
    modulus, variance = curve_fit(lambda s, m: m * (s - s**-2), fit.stretch, fit.stress)
    assert fit.modulus == pytest.approx(modulus[0], rel=1e-6)
    assert fit.error == pytest.approx(2.0 * np.sqrt(variance[0, 0]), rel=1e-5)


def test_a_puck_hardly_pressed_is_refused(tmp_path):
    travel = np.linspace(0, 0.2, 20)
    with pytest.raises(InputError, match="less than 5 % of the thickness"):
        fit_puck(write(tmp_path, "Compression (mm),Force (N)", travel, travel), PuckSize(20.0, 10.0))
