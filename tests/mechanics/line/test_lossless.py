"""Without losses a line has the resonances of textbooks, to 1e-6."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from pneutouch.mechanics.line.dynamics import GasLine, SensorDynamics
from pneutouch.mechanics.line.elements import Duct, GasVolume
from pneutouch.mechanics.line.transient import band_figures
from tests.mechanics.line.lossless import IDEAL

C = IDEAL.sound_speed
TUBE = Duct(300.0, 1.25)
AREA = math.pi * TUBE.radius**2


def resonance(line: tuple, *, cavity: float = 1.0, compliance: float = math.inf) -> float:
    found = band_figures(SensorDynamics(GasVolume(cavity), GasLine(line, IDEAL), compliance)).resonance
    assert found is not None
    return found


def test_a_closed_tube_behind_a_given_pressure_is_a_quarter_wave():
    assert resonance((TUBE,)) == pytest.approx(C / (4 * TUBE.length), rel=1e-6)


def test_the_quarter_wave_is_the_limit_of_a_volume_that_goes():
    assert resonance((TUBE, GasVolume(1e-5))) == pytest.approx(C / (4 * TUBE.length), rel=1e-6)


@pytest.mark.parametrize("volume", [10.0, 300.0, 3000.0])
def test_a_tube_with_a_volume_solves_its_tangent_equation(volume):
    """The roots of cos kL = (V k/A) sin kL for a given pressure at the other end."""
    k = brentq(lambda k: math.cos(k * 300) - volume * k / AREA * math.sin(k * 300), 1e-9, math.pi / 600)
    assert resonance((TUBE, GasVolume(volume))) == pytest.approx(C * k / (2 * math.pi), rel=1e-6)


def test_a_short_neck_before_a_great_volume_is_a_helmholtz_resonator():
    neck, volume = Duct(5.0, 0.5), 1e8
    area = math.pi * neck.radius**2
    helmholtz = C / (2 * math.pi) * math.sqrt(area / (volume * neck.length))
    assert resonance((neck, GasVolume(volume))) == pytest.approx(helmholtz, rel=1e-6)


@pytest.mark.parametrize(("cavity", "end"), [(1657.0, 0.0), (1657.0, 200.0), (50.0, 3000.0)])
def test_between_two_volumes_a_given_flow_finds_the_resonance_of_both(cavity, end):
    """A rigid dome sets the volume: V1 and V2 on a tube, tan kL = k A (V1 + V2)/(k^2 V1 V2 - A^2)."""

    def off(k):
        return math.sin(k * 300) * (k**2 * cavity * end - AREA**2) - math.cos(k * 300) * k * AREA * (cavity + end)

    grid = np.linspace(1e-6, 2 * math.pi / 300, 4000)
    signs = np.sign([off(k) for k in grid])
    first = int(np.argmax(signs[1:] != signs[:-1]))
    k = brentq(off, grid[first], grid[first + 1])
    line = (TUBE, GasVolume(end)) if end else (TUBE,)
    assert resonance(line, cavity=cavity, compliance=0.0) == pytest.approx(C * k / (2 * math.pi), rel=1e-6)


def test_a_wall_that_yields_moves_the_resonance_between_both_ends():
    stiff, soft = resonance((TUBE,), cavity=1657.0, compliance=0.0), resonance((TUBE,))
    between = [resonance((TUBE,), cavity=1657.0, compliance=c) for c in (1e2, 1e4, 1e5, 1e7)]
    assert between == sorted(between, reverse=True)
    assert soft < between[-1] and between[0] < stiff
    assert between[-1] == pytest.approx(soft, rel=1e-2) and between[0] == pytest.approx(stiff, rel=1e-2)
