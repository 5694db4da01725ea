"""Schemas of the TOML files that the program reads, made from their declarations."""

from __future__ import annotations

from functools import partial, reduce
from importlib import import_module
from operator import or_
from typing import Any

from pneutouch.schemas.kind import DocumentKind
from pneutouch.schemas.models import Schema, model_schema
from pneutouch.schemas.sweep import sweep_schema

_MODELS = {
    "design": ("design.DesignFile", "A design", "`designs/`"),
    "target": ("target.Target", "A target", "given to `select`"),
    "tray": ("tray.Tray", "A tray", "given to `tray`"),
    "tasks": ("tasks.TaskFile", "Tasks of a sensor", "given to `pneutouch predict --tasks`"),
    "campaign": ("campaign.Campaign", "A measurement campaign", "given to `characterize` and `calibrate`"),
    "calibration": ("calibration.SensorCalibration", "A calibration of one sensor", "`calibrations/`"),
    "coupons": ("coupon.CouponResults", "What was measured on coupons", "given to `pneutouch coupons --results`"),
    "material": ("material.Material", "A cured material", "`printprofiles/materials/`"),
    "mixing": ("mixing.MixingCurve", "A mixing curve of two resins", "`printprofiles/mixing/`"),
    "printer": ("printer.Printer", "A printer", "`printprofiles/`"),
    "gauge": ("gauge.Gauge", "A pressure gauge", "`printprofiles/gauges/`"),
    "tube": ("part.Tube", "A tube", "`parts/tubes/`"),
    "port": ("part.Port", "A pneumatic port", "`parts/ports/`"),
    "seat": ("part.AnySeat", "A seat of the membrane", "`parts/seats/`"),
    "mount": ("part.AnyMount", "A mounting pattern", "`parts/mounts/`"),
}
"""The model of each file in `spec`, its title, and where such files lie."""


def _of_model(path: str) -> Schema:
    module, _, name = path.partition(".")
    return model_schema(getattr(import_module(f"pneutouch.spec.{module}"), name))


def _specimen() -> Schema:
    """A specimen's file, whose layers are of several kinds."""
    from pneutouch.spec.specimen import LAYERS, Specimen

    kinds: Any = reduce(or_, dict.fromkeys(LAYERS.values()))
    layers, whole = model_schema(kinds), model_schema(Specimen)
    definitions = {key: one for key, one in {**whole["$defs"], **layers["$defs"]}.items() if key != "Layer"}
    whole["properties"]["layer"]["items"] = {"anyOf": layers["anyOf"]}
    return {**whole, "$defs": definitions}


def file_kinds() -> dict[str, DocumentKind]:
    """Every file that is read, by name."""
    declared = {
        name: DocumentKind("TOML", title, where, partial(_of_model, path))
        for name, (path, title, where) in _MODELS.items()
    }
    return {
        **declared,
        "specimen": DocumentKind("TOML", "A texture specimen", "`designs/specimens/`", _specimen),
        "sweep": DocumentKind("TOML", "A sweep", "given to `sweep`", sweep_schema),
    }
