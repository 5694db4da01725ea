"""The rating: nine tenths of the lower end of the least limit, what would raise it, and what it makes of a pressure."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.evaluation.result import rating_record
from pneutouch.mechanics import predict
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.prediction import Limits
from pneutouch.mechanics.rating import Rating, rated_pressure, ratings
from pneutouch.mechanics.uncertainty.document import budget
from pneutouch.mechanics.uncertainty.propagate import LIMIT
from pneutouch.mechanics.uncertainty.sources.model_error import ModelErrors
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.units import KPA
from tests.mechanics.uncertainty.designs import NUMERICAL, materials


def rated(
    library, resin: str = "TangoPlus", limits: Limits | None = None, spread: float | None = None, **size
) -> Rating:
    """The rating of the paper's dome in a resin, its modulus known to ``spread`` (relative) where that is given."""
    material = materials(library)[resin]
    sensor = material_sensor(material).replace(**size)
    if spread is not None:
        modulus = material.shear_modulus_MPa
        modulus = modulus.model_copy(update={"spread": spread * modulus.nominal})
        material = material.model_copy(update={"shear_modulus_MPa": modulus})
    limits = limits or predict("", sensor, [0.0], model="atlas").limits
    return ratings([limits], [sensor], material, library.load("printers", "objet260-connex"))[0]


def test_the_paper_s_sensor_is_rated_below_the_lower_end_of_its_limit_pressure(library):
    found = rated(library)
    assert [found.limit.nominal / KPA, found.limit.low / KPA, found.limit.high / KPA] == pytest.approx(
        [39.6, 21.9, 71.5], abs=0.05
    )
    assert found.pressure == pytest.approx(0.9 * found.limit.low)
    assert found.pressure_kPa == 19.7
    assert "39.6 kPa nominal" in found.basis and "21.9 to 71.5 at k = 2" in found.basis


def test_a_modulus_measured_on_coupons_raises_it_to_what_was_said(library):
    before = rated(library)
    after = rated(library, spread=0.03)
    assert "31.2 kPa" in before.remedy
    assert after.pressure == pytest.approx(before.measured) and after.pressure_kPa == 31.2
    assert after.remedy is None, "the modulus no longer lowers it"


def test_a_measured_modulus_is_a_remedy_only_for_what_it_reaches(library):
    """31.2 kPa with the modulus measured: less than 35 kPa, and than 45 kPa, above the limit pressure itself."""
    found = rated(library)
    for pressure_kPa, said in ((25, True), (31.2, True), (31.3, False), (35, False), (45, False)):
        assert (found.remedy_for(pressure_kPa * KPA) is not None) == said, pressure_kPa
    assert found.remedy_for(25 * KPA) == found.remedy


def test_only_a_sensor_that_a_fit_covers_is_to_be_calibrated(library):
    """The softest silicone is outside the tables of the atlas, which every fit corrects; one with a law is not."""
    soft, cast = (rated(library, name, Limits(0.04, None, 0.1)) for name in ("Ecoflex0010", "DragonSkin20"))
    for fitted in (rated(library), cast):
        assert fitted.remedy.endswith("confirm the nominal modulus, or calibrate a built sensor")
    assert soft.remedy.endswith("confirm the nominal modulus")


def test_the_narrower_the_modulus_is_known_the_higher_the_rating(library):
    pressures = [rated(library, spread=spread).pressure for spread in (0.3, 0.2, 0.1, 0.05, 0.01)]
    assert np.all(np.diff(pressures) > 0)
    assert pressures[-1] < 0.9 * 39.6 * KPA


def test_the_least_lower_end_decides_and_not_the_least_limit(library):
    """A limit point a little above the gauge's range, of a modulus known to a factor, lies below it at its lower end."""
    limits = Limits(limit_point=110 * KPA, break_strain=None, gauge=100 * KPA)
    found = rated(library, limits=limits)
    assert found.limit.name == "limit point" and found.nominal.name == "gauge range"
    assert found.pressure == pytest.approx(0.9 * found.limit.low)
    assert found.severity(99 * KPA) == "warning" and found.severity(101 * KPA) == "error"


def test_a_gauge_that_ends_first_is_taken_as_exact_and_has_no_remedy(library):
    found = rated(library, limits=Limits(limit_point=400 * KPA, break_strain=300 * KPA, gauge=100 * KPA))
    assert found.limit.name == "gauge range" and found.pressure == pytest.approx(90 * KPA)
    assert found.remedy is None


def test_the_break_strain_is_as_uncertain_as_the_modulus(library):
    found = rated(library, limits=Limits(limit_point=39.6 * KPA, break_strain=30 * KPA, gauge=100 * KPA))
    assert found.limit.name == "break strain"
    assert found.limit.low / found.limit.nominal == pytest.approx(rated(library).limit.low / 39.592 / KPA, rel=1e-4)


def test_a_wall_without_a_limit_point_is_rated_by_the_gauge(library):
    found = rated(library, limits=Limits(limit_point=None, break_strain=None, gauge=100 * KPA))
    assert found.pressure == pytest.approx(90 * KPA) and found.remedy is None


def test_pressures_are_judged_at_the_rating_and_at_the_nominal_limit(library):
    found = rated(library)
    limit = found.nominal.nominal
    pressures = [found.pressure, 1.001 * found.pressure, limit, 1.001 * limit]
    assert [found.severity(p) for p in pressures] == [None, "warning", "warning", "error"]
    record = rating_record(found, [0.0, 22 * KPA, 45 * KPA])
    assert [(f.severity, f.driving_pressure_kPa) for f in record.findings] == [("warning", 22), ("error", 45)]
    assert record.rated_pressure_kPa == pytest.approx(0.9 * record.limit_low_kPa, rel=1e-4)


def test_many_sensors_are_rated_as_one_is(library):
    one = rated(library)
    many = rated_pressure(np.full(3, one.limit.nominal), np.array([0.0, 0.1, 0.3]), np.array([1.0, 1.0, 0.01]))
    assert many == pytest.approx([0.9 * one.limit.nominal, 0.9 * one.limit.nominal * np.exp(-0.2), 0.009])


def calibrated(modulus: float, wall: float, correlation: float) -> SensorCalibration:
    """The paper's sensor with standard deviations (relative) of a fitted modulus and wall and their correlation."""
    both = correlation * modulus * wall
    return SensorCalibration.model_validate(
        {
            "format": "pneutouch/calibration/1",
            "title": "made up",
            "covariance": [[modulus**2, both], [both, wall**2]],
            "source": {
                **{"sensor": "A1", "digest": "ab" * 32, "simulated": True, "curves": 0, "injections": 1},
                **{"driving_pressures_kPa": [], "age_days": 365.0},
            },
            "design": {
                **{"name": "paper-dome", "material": "TangoPlus", "inner_radius_mm": 9.25},
                **{"wall_thickness_mm": 1.5, "dead_volume_mL": 0.0},
            },
            "parameters": [
                {"key": "shear_modulus_MPa", "value": 0.17, "fitted": True, "covered": True},
                {"key": "wall_thickness_mm", "value": 1.5, "fitted": True, "covered": True},
                {"key": "dead_volume_mL", "value": 0.0, "fitted": False, "covered": False},
            ],
        }
    )


@pytest.mark.parametrize("correlation", [-0.95, 0.0, 0.95])
def test_a_calibration_raises_it_by_its_own_covariance(library, correlation):
    """Modulus and wall that a fit can exchange for one another: their product, the limit pressure, is known better."""
    material, printer = materials(library)["TangoPlus"], library.load("printers", "objet260-connex")
    sensor, known = material_sensor(material), calibrated(0.08, 0.06, correlation)
    limits = predict("", sensor, [0.0], model="atlas").limits
    found = ratings([limits], [sensor], material, printer, known)[0]
    assert found.pressure > 1.2 * ratings([limits], [sensor], material, printer)[0].pressure
    spread = np.sqrt(0.08**2 + 0.06**2 + 2 * correlation * 0.08 * 0.06)
    # The wall's slope is 1.04 and the radius adds 0.3 %.
    assert np.log(found.limit.nominal / found.limit.low) == pytest.approx(2 * spread, rel=0.06, abs=0.01)
    assert found.remedy is None, "a coupon says nothing of a modulus that was fitted"
    whole = budget(
        batch_of(sensor, [0.0]),
        material,
        printer,
        near_paper=True,
        errors=ModelErrors(),
        numerical=NUMERICAL,
        calibration=known,
    )
    assert np.log(found.limit.nominal / found.limit.low) == pytest.approx(whole.expanded[LIMIT, 0], rel=5e-3)
