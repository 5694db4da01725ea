"""The options of the commands that compute from runs and designs, declared once.

The command line takes each as a flag, Python as a keyword of the field's name, the studio as a field of its form; all
three are checked here.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar, get_args

from pydantic import AfterValidator, BeforeValidator, Field, JsonValue, model_validator
from pydantic_core import PydanticUndefined

from pneutouch.spec.campaign import PlannedKind
from pneutouch.spec.fields import FieldsError, Table, extra_of, list_check
from pneutouch.spec.read import validate

SPEEDS_MM_PER_S = (0.01, 1000.0)
"""Slowest and fastest scan: a 60 mm path then lasts 1.7 h and 0.06 s."""

_USUAL = "solid; harmonic for contact off the axis"


class Options(Table):
    """Base of the options of a command."""


AnyOptions = TypeVar("AnyOptions", bound=Options)


def option(
    default: Any,
    help: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    flag: str | None = None,
    metavar: str | None = None,
    registry: str | None = None,
    shown: str | None = None,
    separator: str = ",",
) -> Any:
    """Declare an option: number or numbers in ``unit`` from ``low`` to ``high``, or names of a ``registry``.

    Args:
        default: Its value where it is left out.
        help: One sentence.
        unit: Unit, as in the field's name.
        low: Least value of the number; stated only, not checked, for the entries of a list.
        high: Greatest value, checked as ``low`` is.
        flag: Name on the command line; None: the field's without its unit. A flag ``no-...`` sets the option to False.
        metavar: Placeholder for the value in the help of the command line.
        registry: Kind of the catalogue, such as materials, that the names belong to.
        shown: Words that stand for a default which is computed.
        separator: Text between the entries of a list on the command line.
    """
    extra: dict[str, JsonValue] = {"unit": unit, "low": low, "high": high, "registry": registry}
    extra |= {"flag": flag, "metavar": metavar, "shown": shown, "separator": separator}
    listed = isinstance(default, list)
    return Field(
        default=default,
        ge=None if listed else low,
        le=None if listed else high,
        description=help,
        json_schema_extra=extra,
    )


def _some(values: list[Any]) -> list[Any]:
    if not values:
        raise ValueError("must name at least one")
    return values


_AT_LEAST_ONE = AfterValidator(_some)
_PRESSURES = AfterValidator(list_check(0.0, 1000.0, "kPa"))
_AGES = AfterValidator(list_check(0.0, 36_500.0, "days"))
_ONCE = AfterValidator(list_check(0.0, 0.0, ""))
_READINGS = AfterValidator(list_check(0.0, 100.0, "", once=False, ends=False))
_PUCK = AfterValidator(list_check(0.05, 1000.0, "mm", once=False))
FilePath = Annotated[Path, BeforeValidator(lambda value: Path(value) if isinstance(value, str) else value)]
"""Path of a file, which may be given as text."""


def options_of(model: type[AnyOptions], values: Mapping[str, Any]) -> AnyOptions:
    """Options of ``model`` among ``values``, by field; None: the default. Raises InputError that names the field."""
    fields = model.model_fields
    given = {
        key: value
        for key, value in values.items()
        if key in fields and (value is not None or fields[key].get_default() is PydanticUndefined)
    }
    return validate(model, given, None)


def flag_of(model: type[Options], key: str) -> str:
    """Name of an option's parameter on the command line, such as ``speed`` for ``speed_mm_per_s``."""
    stated = extra_of(model, key)["flag"]
    return str(stated).replace("-", "_") if stated else re.sub(r"_(mm|N|kPa|Hz|s|days|g)(_per_\w+)?$", "", key)


def option_words(options: Options) -> list[tuple[str, str]]:
    """Pairs of parameter and text that give the same options on a command line; the text of a switch is empty."""
    model, words = type(options), []
    for key, field in model.model_fields.items():
        value = getattr(options, key)
        if value != field.get_default():
            listed = value if isinstance(value, list) else [value]
            separator = str(extra_of(model, key)["separator"])
            text = "" if isinstance(value, bool) else separator.join(_word(entry) for entry in listed)
            words.append((flag_of(model, key), text))
    return words


def _word(value: Any) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


class PlanOptions(Options):
    """Options of ``plan``."""

    resins: Annotated[list[str], _ONCE] = option(
        [],
        "Resins of the dome, or all of the paper's; left out: the design's.",
        registry="materials",
        metavar="NAME,NAME",
    )
    specimens: int = option(3, "Specimens of each resin.", low=1, high=1000)


class SimulationOptions(PlanOptions):
    """Options of ``simulate``."""

    driving_pressures_kPa: Annotated[list[float], _PRESSURES, _AT_LEAST_ONE] | None = option(
        None, "Driving pressures, kPa; left out: the design's.", unit="kPa", flag="pressures", metavar="KPA,KPA"
    )
    runs: int = option(3, "Runs of each steps and saturation test; other kinds have one.", low=1, high=1000)
    kinds: Annotated[list[PlannedKind], _ONCE, _AT_LEAST_ONE] = option(
        ["steps", "loop", "relaxation"], f"Of {', '.join(get_args(PlannedKind))}.", metavar="KIND,KIND"
    )
    rate_Hz: float = option(100.0, "Samples a second, Hz.", unit="Hz", low=10, high=1e5)
    rest_s: float | None = option(
        None, "Longest rest, s; left out: the paper's 30 s and 2 s.", unit="s", low=0.2, high=3600, metavar="S"
    )
    seed: int = option(0, "Seed of scatter and noise.", low=0, high=1e9)
    ages_days: Annotated[list[float], _AGES, _AT_LEAST_ONE] = option(
        [0.0], "Ages at which every specimen is measured, days.", unit="days", metavar="DAYS,DAYS"
    )
    model: str | None = option(None, "What presses the specimens: solid, harmonic, atlas or auto.", shown=_USUAL)
    parquet: bool = option(False, "Parquet files instead of CSV.")


class ScanOptions(Options):
    """Options of ``scan``."""

    driving_pressures_kPa: Annotated[list[float], _PRESSURES] = option(
        [0.0, 22.0],
        "Driving pressures, kPa; empty: measured data alone.",
        unit="kPa",
        flag="pressures",
        metavar="KPA,KPA",
    )
    preload_N: float = option(0.5, "Normal force at which the height is set, N.", unit="N", low=1e-6, high=1000)
    speed_mm_per_s: float | None = option(
        None,
        "Speed along the path, mm/s; left out: the specimen's.",
        unit="mm/s",
        low=SPEEDS_MM_PER_S[0],
        high=SPEEDS_MM_PER_S[1],
    )
    control: Literal["height", "force"] = option("height", "Quantity held constant along the path: height or force.")
    noise_kPa: float | None = option(
        None, "White noise of a sample, kPa rms; left out: one step of the recorder.", unit="kPa", low=0, high=100
    )
    seed: int = option(0, "Seed of the noise.", low=0, high=1e9)
    data: list[FilePath] = option(
        [], "Measured signal, CSV with time_s and pressure_kPa; may be repeated.", metavar="FILE"
    )

    @model_validator(mode="after")
    def _scans(self) -> Self:
        if not self.driving_pressures_kPa and not self.data:
            raise FieldsError("no driving pressure and no data: nothing to scan", "driving_pressures_kPa", "data")
        return self


class CalibrationOptions(Options):
    """Options of ``calibrate``."""

    sensor: str | None = option(None, "Sensor of the campaign.", metavar="NAME", shown="its only one")
    fit: Annotated[list[str], _ONCE, _AT_LEAST_ONE] = option(
        ["modulus", "dead-volume", "wall", "offset"],
        "What to fit: modulus, wall, dead-volume, offset, friction.",
        metavar="NAMES",
    )
    hold_out_kPa: Annotated[list[float], _PRESSURES] = option(
        [], "Driving pressures to predict by the others.", unit="kPa", metavar="KPA,KPA"
    )
    priors: bool = option(True, "Fit to the measurements alone.", flag="no-priors")
    save: str | None = option(
        None, "Name of the calibration in the user's folder.", metavar="NAME", shown="design and sensor"
    )
    replace: bool = option(False, "Replace a calibration of that name.", flag="force")


_SPECIMEN = "Of the tensile specimen."


def _length(help: str) -> Any:
    return option(None, help, unit="mm", low=0.05, high=1000, metavar="MM", shown="as the file states")


class FitOptions(Options):
    """Options of ``fit-material``."""

    name: str = option(..., "Name of the material, as designs name it.", metavar="NAME")
    like: str | None = option(
        None, "Known material whose density, hardness and casting are kept.", registry="materials"
    )
    density_g_per_cm3: float | None = option(None, "Density of a material that is new.", metavar="G/CM3")
    shore_a: Annotated[list[float], _READINGS] = option([], "Readings of the hardness, Shore A.", metavar="N,N,...")
    gauge_length_mm: float | None = _length(_SPECIMEN)
    width_mm: float | None = _length(_SPECIMEN)
    thickness_mm: float | None = _length(_SPECIMEN)
    opening_mm: float | None = _length("Diameter in which an inflated disc is free.")
    kinds: list[Literal["tension", "planar", "equibiaxial"]] = option(
        [], "Kind of each file: tension, planar, equibiaxial.", metavar="KIND,KIND", shown="as its columns say"
    )
    puck_mm: Annotated[list[float], Field(min_length=2, max_length=2), _PUCK] | None = option(
        None,
        "A puck pressed between plates: diameter and thickness in mm, such as 20x6.",
        unit="mm",
        metavar="DxT",
        separator="x",
    )
    bonded: bool = option(False, "The puck's faces cannot slide on the plates.")
    stretch_to: float | None = option(
        None, "Fit up to there.", low=1.1, high=20, metavar="STRETCH", shown="what a sensor reaches"
    )
    slack: float | None = option(
        None, "Strain before the specimen pulls.", low=0, high=0.5, metavar="STRAIN", shown="found"
    )
    lab: str | None = option(None, "Who measured, for the sources.")

    @model_validator(mode="after")
    def _of_a_puck(self) -> Self:
        if self.bonded and self.puck_mm is None:
            raise FieldsError("is of a puck; give `puck_mm` too", "bonded")
        return self


class DiscriminationOptions(Options):
    """Options of ``discriminate``."""

    driving_pressures_kPa: Annotated[list[float], _PRESSURES] = option(
        [],
        "Driving pressures of the readings, kPa; left out: the design's.",
        unit="kPa",
        flag="pressures",
        metavar="KPA,KPA",
    )
    unknown: Annotated[list[str], _ONCE, _AT_LEAST_ONE] = option(
        ["radius", "force"],
        "What is told: radius,force of plates and balls, or modulus,force of blocks.",
        metavar="A,B",
    )
    moduli_MPa: Annotated[list[float], AfterValidator(list_check(0.001, 1e4, "MPa"))] = option(
        [0.07, 0.15, 0.6],
        "Moduli of blocks to be told apart, and from a rigid plate, MPa: by default those of soft to firm silicones.",
        unit="MPa",
        flag="moduli",
        metavar="MPA,MPA",
    )
    least_modulus_MPa: float = option(
        0.05, "Modulus of the softest block that may press, MPa.", unit="MPa", low=0.001, high=1e3, flag="least-modulus"
    )
    thickness_mm: float | None = option(
        None, "Thickness of the blocks on a rigid ground, mm; left out: they are deep.", unit="mm", low=0.2, high=500
    )
    travel_noise_mm: float | None = option(
        None,
        "Standard deviation of the travel since first contact, mm, if a stage reads it.",
        unit="mm",
        low=1e-4,
        high=10,
    )
    classes_mm: Annotated[list[float], AfterValidator(list_check(0.05, 1000.0, "mm"))] = option(
        [20.0, 8.0], "Radii of balls to be told apart, and from a plate, mm.", unit="mm", flag="balls", metavar="MM,MM"
    )
    least_radius_mm: float = option(6.0, "Radius of the smallest ball that may press, mm.", unit="mm", low=1, high=1000)
    error_percent: float = option(
        1.0, "Error of a rise that readings do not share, percent of it: our choice.", unit="%", low=0.5, high=50
    )
    noise_kPa: float | None = option(
        None,
        "Standard deviation of a rise that is read, kPa; left out: that of two readings of the design's gauge.",
        unit="kPa",
        low=1e-6,
        high=10,
    )
    plan: int | None = option(None, "Choose so many driving pressures that tell most.", low=1, high=4, metavar="N")
