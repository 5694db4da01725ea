"""Measured coupons to figures, and to profiles of the lab's own."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneutouch.bench.finding import CouponFindings, ReadingSource
from pneutouch.bench.machine import gauges
from pneutouch.bench.resin import dumbbell, puck
from pneutouch.bench.volume import leak, volume
from pneutouch.catalogue import KINDS, Library, load_scene, user_folder
from pneutouch.errors import InputError
from pneutouch.spec.coupon import CouponResults, FeatureGauge, read_results
from pneutouch.spec.material import Material
from pneutouch.spec.names import file_name
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import read_toml
from pneutouch.workflows.coupons.mixing import local_curve
from pneutouch.workflows.coupons.profile import MeasuredProfile, base_file, local_profiles, write_profiles


def enter_results(path: Path, out: Path | None = None, library: Library | None = None) -> dict[str, Any]:
    """Read a results file, compute, and write local profiles under ``out``, else in the user's folder; all as data.

    Raises InputError for a bad file, for one without readings, and rather than overwrite a profile that is not ours.
    """
    library, out = library or Library.default(), out or user_folder()
    results = read_results(path)
    findings = evaluate_results(results, str(path), library)
    here = ReadingSource(str(path), results.lab, results.date)
    curves = [local_curve(pair, read, here, library, out, findings) for pair, read in results.mixing.items()]
    if not (findings.changes or findings.figures or findings.notes):
        raise InputError("nothing measured: every list is empty", file=path, remedy="fill in some readings")
    source = ReadingSource(file_name(path.name), results.lab, results.date)
    profiles = local_profiles(findings.changes, source, library, out) + [curve for curve in curves if curve is not None]
    write_profiles(profiles)
    return _document(results, findings, profiles)


def evaluate_results(results: CouponResults, where: str, library: Library) -> CouponFindings:
    """Figures and changed quantities of a results file; ``where`` is the file, for messages."""
    findings, source = CouponFindings(), ReadingSource(where, results.lab, results.date)
    for name, read in results.puck.items():
        puck(name, _material(name, where, "puck", library), read, source, findings)
    for name, pulled in results.dumbbell.items():
        dumbbell(name, _material(name, where, "dumbbell", library), pulled, source, findings)
    for name, by_material in results.gauge.items():
        _gauges(name, by_material, source, library, findings)
    for name in dict.fromkeys((*results.leak_cap, *results.volume_plug)):
        cap, plug = results.leak_cap.get(name), results.volume_plug.get(name)
        scene = load_scene(_design(name, where, library), None, library)
        if cap is not None:
            leak(name, cap, 0.0 if plug is None else plug.gauge_accuracy_kPa, source, findings)
        if plug is not None and (plug.pressure_kPa or plug.water_g):
            volume(name, scene, cap, plug, source, findings)
    return findings


def _gauges(
    name: str,
    by_material: Mapping[str, FeatureGauge],
    source: ReadingSource,
    library: Library,
    findings: CouponFindings,
) -> None:
    printer: Printer = _shipped("printers", name, source.where, "gauge", library)
    measured = []
    for material_name, gauge in by_material.items():
        material = _material(material_name, source.where, f"gauge.{name}", library)
        if printer.mode_for(material) is None:
            raise InputError(
                f"gauge.{name}.{material_name}: the {printer.title} cannot run {material.label}",
                file=source.where,
                remedy=f"it runs {', '.join(printer.resins)}",
            )
        measured.append((material_name, material, gauge))
    gauges(name, printer, measured, source, findings)


def _material(name: str, file: str, key: str, library: Library) -> Material:
    material: Material = _shipped("materials", name, file, key, library)
    return material


def _shipped(kind: str, name: str, file: str, key: str, library: Library) -> Any:
    """A profile as it was before the command wrote one. Raises InputError if the name is unknown."""
    library.load(kind, name, file=file, key=key)
    path = base_file(kind, name, library)
    return KINDS[kind].validate(read_toml(path), str(path))


def _design(name: str, where: str, library: Library) -> str:
    if name not in library.paths("designs"):
        library.load("designs", name, file=where, key="leak-cap or volume-plug")
    return name


def _document(results: CouponResults, findings: CouponFindings, profiles: list[MeasuredProfile]) -> dict[str, Any]:
    return {
        "lab": results.lab,
        "date": results.date.isoformat(),
        "written": [str(profile.path) for profile in profiles],
        "changes": [change for profile in profiles for change in profile.changes],
        "figures": [
            {"about": f.about, "name": f.name, "value": f.value, "spread": f.spread, "count": f.count}
            for f in findings.figures
        ],
        "notes": findings.notes,
    }
