"""The calibration file: one sensor's fitted parameters, its model error, and the design that it was made to."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from pneutouch.errors import shown
from pneutouch.formats import problem_of
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, number
from pneutouch.spec.grade import ResinOrMix
from pneutouch.wording import data_of

if TYPE_CHECKING:
    from pneutouch.shape.dome import DomeShape

ParameterKey = Literal["shear_modulus_MPa", "wall_thickness_mm", "dead_volume_mL", "contact_offset_mm", "friction"]

Factor = Annotated[float, Field(ge=0.2, le=5)]
RelativeError = Annotated[float, Field(ge=0, le=2)]
HeldOutError = Annotated[float, Field(ge=-0.9, le=10)]
DrivingPressure = Annotated[float, Field(ge=0, le=1000)]

_MOST_VARIANCE: dict[str, float] = data_of(__file__)
"""Greatest variances in a covariance, in the units of `SensorCalibration`: standard deviations of a factor of 7, 10 mL,
10 mm and 2. A fit with more has not seen the parameter, and figures by it would not be finite."""

_BY_PRESSURE = ("force_factors", "pressure_factors", "sensitivity_errors_relative", "force_errors_relative")

_ROUNDING = 1e-6


class CalibrationSource(Table):
    """[source]: the measurement behind the calibration."""

    sensor: Printable = Field(min_length=1, max_length=60, description="Name of the specimen.")
    campaign: Printable = Field(default="", max_length=120, description="Title of the campaign.")
    lab: Printable = Field(default="", max_length=120, description="Who measured.")
    digest: str = Field(
        pattern="^[0-9a-f]{64}$",
        description="SHA-256 of the campaign file and of the files of the runs that were used.",
    )
    simulated: bool = Field(description="True if a program made the runs.")
    curves: int = Field(ge=0, le=100_000, description="Number of loading curves.")
    injections: int = Field(ge=0, le=100_000, description="Number of injection runs.")
    driving_pressures_kPa: list[DrivingPressure] = Field(
        max_length=1000, description="Driving pressures of the curves."
    )
    ambient_pressure_kPa: float = number(101.325, unit="kPa", low=20, high=1000, help="Absolute pressure there.")
    age_days: float = number(0.0, unit="d", low=0, high=36_500, help="Age of the print, mean over the runs.")
    depth_mm: float | None = Field(
        default=None, gt=0, le=1000, description="Greatest travel that was measured and used."
    )
    plate_diameter_mm: float | None = Field(default=None, gt=0, le=500, description="Plate that it was measured with.")
    contact: Printable | None = Field(
        default=None, max_length=200, description="Object that it was measured with, if that is no frictionless plate."
    )


class CalibratedDesign(Table):
    """[design]: the design that the sensor was made to; the calibration holds for its resin and membrane alone."""

    name: Printable = Field(min_length=1, max_length=200, description="Name of the design.")
    material: ResinOrMix = Field(description="Resin of the membrane.")
    inner_radius_mm: float = Field(ge=1, le=100, description="Inner radius as designed.")
    wall_thickness_mm: float = Field(ge=0.05, le=50, description="Wall as designed.")
    shape: str = Field(default="hemisphere", min_length=1, max_length=100, description="Shape of the dome.")
    sizes: dict[str, float | list[list[float]]] = Field(
        default_factory=dict, max_length=10, description="Its sizes besides radius and wall, by key, as designed."
    )
    dead_volume_mL: float = Field(ge=0, le=1000, description="Dead volume as designed.")


class CalibratedParameter(Table):
    """One [[parameters]] entry: a parameter with its value, fitted or as designed."""

    key: ParameterKey = Field(description="Name with unit.")
    value: float = Field(description="Fitted, or as designed where it was not fitted.")
    fitted: bool = Field(description="Whether it was fitted.")
    covered: bool = Field(description="Whether it has a row of the covariance.")

    @model_validator(mode="after")
    def _possible(self) -> "CalibratedParameter":
        least = {"shear_modulus_MPa": 1e-6, "wall_thickness_mm": 1e-3, "dead_volume_mL": 0.0, "friction": 0.0}.get(
            self.key, -10.0
        )
        if not least <= self.value <= 1000.0:
            raise ValueError(f"{self.key} = {self.value:g}: must be from {least:g} to 1000")
        return self


class CalibratedResponse(Table):
    """[response]: the error of the fitted model: factors that correct it, by driving pressure, and the errors left."""

    force_factors: list[Factor] = Field(description="Measured force over that of the fitted model, by pressure.")
    pressure_factors: list[Factor] = Field(description="Measured pressure rise over that of the fitted model.")
    sensitivity_errors_relative: list[RelativeError] = Field(
        description="Standard uncertainty of the corrected model's sensitivity there."
    )
    force_errors_relative: list[RelativeError] = Field(description="The same of its force.")
    errors_freedom: float = Field(
        default=0.0,
        ge=0,
        le=1e6,
        description="Degrees of freedom of these errors, the fewest there; 0 where the scatter of the runs is assumed.",
    )
    held_out_pressures_kPa: list[DrivingPressure] = Field(
        max_length=1000, description="Driving pressures left out of a fit."
    )
    held_out_sensitivity_errors: list[HeldOutError] = Field(
        max_length=1000, description="Prediction by that fit, likewise."
    )


class SensorCalibration(Table):
    """A calibration file.

    ``covariance`` is of the logarithms of modulus (MPa) and wall (mm), of dead volume (mL), offset (mm) and friction.
    """

    format: str = Field(description="Format of the file and its version.")
    title: Printable = Field(min_length=1, max_length=200, description="Sensor and measurement behind it.")
    covariance: list[list[float]] = Field(max_length=5, description="Of the covered parameters, in their order.")
    source: CalibrationSource
    design: CalibratedDesign
    parameters: list[CalibratedParameter] = Field(min_length=3, max_length=5)
    response: CalibratedResponse | None = Field(default=None, description="Left out where no curve was measured.")

    @model_validator(mode="after")
    def _of_this_form(self) -> "SensorCalibration":
        problem = problem_of("calibration", self.format)
        if problem is not None:
            raise ValueError(f"format = {shown(self.format)}: {problem[0]}; {problem[1]}")
        return self

    @model_validator(mode="after")
    def _each_parameter_once(self) -> "SensorCalibration":
        keys = [parameter.key for parameter in self.parameters]
        missing = {"shear_modulus_MPa", "wall_thickness_mm", "dead_volume_mL"} - set(keys)
        if missing or len(set(keys)) != len(keys):
            raise ValueError("parameters: modulus, wall and dead volume must each be there once")
        return self

    @model_validator(mode="after")
    def _is_a_covariance(self) -> "SensorCalibration":
        size = sum(parameter.covered for parameter in self.parameters)
        if len(self.covariance) != size or any(len(row) != size for row in self.covariance):
            raise ValueError(f"covariance: must be {size} rows of {size} numbers, one for each covered parameter")
        if not size:
            return self
        for k, key in enumerate(self.covered):
            if abs(self.covariance[k][k]) > _MOST_VARIANCE[key]:
                raise ValueError(f"covariance: that of {key} must be at most {_MOST_VARIANCE[key]:g}")
        matrix = np.array(self.covariance)
        spread = np.sqrt(np.maximum(np.diag(matrix), 0.0))
        unit = matrix / np.outer(np.where(spread > 0, spread, 1.0), np.where(spread > 0, spread, 1.0))
        if not np.allclose(unit, unit.T, atol=_ROUNDING) or float(np.linalg.eigvalsh(unit).min()) < -_ROUNDING:
            raise ValueError("covariance: must be symmetric, without negative eigenvalues")
        return self

    @model_validator(mode="after")
    def _curves_have_a_response(self) -> "SensorCalibration":
        if (self.response is None) != (self.source.curves == 0):
            raise ValueError("response: must be there where curves were measured, and only there")
        pressures_kPa = self.source.driving_pressures_kPa
        if self.response is None:
            return self
        if not pressures_kPa or sorted(set(pressures_kPa)) != pressures_kPa:
            raise ValueError("source.driving_pressures_kPa: must name those of the curves, ascending")
        lists = [getattr(self.response, key) for key in _BY_PRESSURE]
        if any(len(values) != len(pressures_kPa) for values in lists):
            raise ValueError(f"response: {', '.join(_BY_PRESSURE)} must have a number for each driving pressure")
        if len(self.response.held_out_pressures_kPa) != len(self.response.held_out_sensitivity_errors):
            raise ValueError(
                "response: held_out_sensitivity_errors must have a number for each of held_out_pressures_kPa"
            )
        return self

    def value(self, key: ParameterKey) -> float:
        """Value of the parameter ``key``, in the unit of the key."""
        return next(parameter.value for parameter in self.parameters if parameter.key == key)

    @property
    def covered(self) -> tuple[ParameterKey, ...]:
        """Keys of the parameters that have a row in the covariance, in the order of the rows."""
        return tuple(parameter.key for parameter in self.parameters if parameter.covered)

    @property
    def remaining_year(self) -> float:
        """Share, 0 to 1, of the first year after printing that was still to come when it was measured."""
        return max(0.0, 1.0 - self.source.age_days / 365.0)

    def misfit(self, material: object, dome: "DomeShape") -> str | None:
        """Reason why the calibration does not hold for a membrane of a resin or mix, or None if it does.

        Another resin has another modulus. Another shape, radius or wall is another print, whose deviations from its
        drawing are its own, and the model's error was found at this one alone.
        """
        made = self.design
        if material != made.material:
            return f"was made with a membrane of {_named(made.material)}, this one is of {_named(material)}"
        if dome.key != made.shape:
            return f"was made with a membrane of the shape {made.shape}, this one is a {dome.key}"
        for name, here, there in (
            ("inner radius", dome.inner_radius, made.inner_radius_mm),
            ("wall", dome.wall_thickness, made.wall_thickness_mm),
        ):
            if not math.isclose(here, there, rel_tol=_ROUNDING):
                return f"was made with a membrane of {name} {there:g} mm, this one has {here:g} mm"
        # The shapes load NumPy and the meridian, which reading a file does not need.
        from pneutouch.shape import stated_sizes

        return _other_size(made.sizes, stated_sizes(dome))


def _other_size(made: Mapping[str, Any], here: Mapping[str, Any]) -> str | None:
    """Sentence on the first size that differs from the one ``made``; None if none does."""
    for key in sorted({*made, *here}):
        there, now = made.get(key, 0.0), here.get(key, 0.0)
        points = np.shape(there), np.shape(now)
        if points[0] != points[1] or not np.allclose(there, now, rtol=_ROUNDING, atol=_ROUNDING):
            if points == ((), ()):
                return f"was made with a membrane of {key} = {there:g}, this one has {now:g}"
            return f"was made with a membrane of other points in {key}"
    return None


def _named(material: object) -> str:
    return material if isinstance(material, str) else str(getattr(material, "label", material))
