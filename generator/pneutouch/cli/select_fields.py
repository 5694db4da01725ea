"""The options of ``select``: a flag for each field of a target, and a target as the words that give it."""

import shlex
from functools import partial
from typing import Any

from pneutouch.cli.declared import FieldOption
from pneutouch.cli.percent import percent_of
from pneutouch.errors import InputError
from pneutouch.spec.number import plain_numbers
from pneutouch.spec.target import Target


def _pressures(text: str) -> list[float]:
    try:
        return plain_numbers(text)
    except ValueError:
        raise InputError("write two driving pressures in kPa, such as 0,22", key="same_at", value=text) from None


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


_PERCENT = "PERCENT"
"""Metavar of an option in per cent."""

SELECT_FIELDS = {
    "sensitivity": FieldOption("target", "sensitivity_kPa_per_N"),
    "tolerance": FieldOption("target", "tolerance_percent", partial(percent_of, parameter="tolerance"), _PERCENT),
    "at": FieldOption("target", "driving_pressure_kPa"),
    "force_range": FieldOption("target", "force_range_N"),
    "stiffness_least": FieldOption("target", "stiffness_least_N_per_mm"),
    "stiffness_most": FieldOption("target", "stiffness_most_N_per_mm"),
    "max_diameter": FieldOption("target", "max_diameter_mm"),
    "max_footprint": FieldOption("target", "max_footprint_mm"),
    "fits": FieldOption("target", "fits", metavar="finger:MM"),
    "inner_radius": FieldOption("given", "inner_radius_mm"),
    "wall": FieldOption("given", "wall_thickness_mm"),
    "material": FieldOption("given", "materials"),
    "mix": FieldOption("given", "mix", metavar="SOFT+STIFF"),
    "graded": FieldOption("given", "graded"),
    "same_at": FieldOption("target", "same_sensitivity_at_kPa", _pressures, "KPA,KPA"),
    "same_within": FieldOption("target", "same_within_percent", partial(percent_of, parameter="same_within"), _PERCENT),
    "widest_range": FieldOption("target", "widest_range"),
    "base": FieldOption("setting", "base"),
    "profile": FieldOption("setting", "profile"),
    "process": FieldOption("setting", "processes", _names, "PROCESS,...|any"),
    "tube_length": FieldOption("setting", "tube_length_mm"),
    "dead_volume": FieldOption("setting", "dead_volume_mL"),
    "gauge": FieldOption("setting", "gauge", metavar="NAME|any"),
    "robustness": FieldOption("weights", "robustness"),
    "tunability": FieldOption("weights", "tunability"),
    "contact_anywhere": FieldOption("weights", "contact_anywhere"),
}
"""Field of a target by the parameter of its option."""


def target_words(target: Target) -> list[str]:
    """The options that give the same target as a file, in the order of `SELECT_FIELDS`."""
    words = []
    for name, option in SELECT_FIELDS.items():
        table = getattr(target, option.table)
        value = getattr(table, option.key)
        if option.key not in table.model_fields_set or value is None or value is False:
            continue
        flag = f"--{name.replace('_', '-')}"
        words += [flag] if value is True else [flag, _text(value, "%" if option.metavar == _PERCENT else "")]
    return [*words, *(word for text in target.setting.assignments for word in ("--set", text))]


def saving_command(target: Target, rank: int, name: str) -> str:
    """The command that saves the design of a rank under a name, as it is typed in a shell."""
    picked = [] if rank == 1 else ["--pick", str(rank)]
    return shlex.join(["pneutouch", "select", *target_words(target), *picked, "--write", name])


def _text(value: Any, unit: str) -> str:
    if isinstance(value, list):
        return ",".join(_text(each, unit) for each in value)
    return value if isinstance(value, str) else f"{value:.12g}{unit}"
