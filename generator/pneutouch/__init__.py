"""pneutouch: pneumatic touch sensors, from a design file to print files, a prediction and a datasheet.

The public names are loaded when they are first used: ``import pneutouch as pt``, then ``pt.Design(...).predict()``.
"""

__version__ = "1.0.0"

_HOMES = {
    "api.design": ("Design", "load"),
    "api.prediction": ("FigureValue", "PredictedState", "Prediction"),
    "api.results": ("CheckResult", "DrivingResult", "Result"),
    "api.search": ("Selection", "map_sweep", "select", "sweep"),
    "api.comparison": ("Comparison", "compare"),
    "api.measuring": (
        "FittedSensor",
        "calibrate",
        "characterize",
        "fit_material",
        "plan",
        "respond",
        "scan",
        "simulate",
    ),
    "api.pad": ("Pad", "PadContact", "PadEstimate", "PadResolution", "PadTouch", "load_pad"),
    "api.show": ("Listing", "calibrations", "designs", "gauges", "materials", "printers"),
    "errors": ("ComputationError", "InputError", "PneutouchError", "RuleBrokenError"),
}
__all__ = [*sorted(name for names in _HOMES.values() for name in names), "__version__"]


def __getattr__(name: str) -> object:
    from importlib import import_module

    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"pneutouch.{home}"), name)
    raise AttributeError(f"module 'pneutouch' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
