"""Results of measured coupons: figures, the laboratory's own profiles, and its own mixing curve."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.bench.coupon_resin import MixModulus, dumbbell, puck, stiffness
from pneutouch.bench.coupons import DIGITS, MARK, CouponFindings, ProfileChange, ReadingSource, gauges, leak, volume
from pneutouch.catalogue import KINDS, Library, load_scene, user_folder
from pneutouch.catalogue.mixture import mixing
from pneutouch.errors import InputError
from pneutouch.output.files import replace_files
from pneutouch.results.coupons import ChangedQuantity, CouponReport, MeasuredFigure
from pneutouch.spec.coupon import CouponResults, FeatureGauge, MixedCoupons, read_results
from pneutouch.spec.files import check_of, head_of, is_of, whole_head
from pneutouch.spec.grade import MixingCurve, MixingPoint
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.values import file_name
from pneutouch.wording import rounded
from pneutouch.workflows.coupons.order import resins_of

_COMMAND = "coupons"
HEAD = head_of(_COMMAND)
"""First words of every profile that the command may overwrite."""


@dataclass(frozen=True, slots=True)
class MeasuredProfile:
    """A profile to write: path, text, and the quantities that it changes."""

    path: Path
    text: str
    changes: Sequence[ChangedQuantity]


def base_file(kind: str, name: str, library: Library) -> Path:
    """Path of the first profile of this name that the command did not write; without one, of the first that it
    wrote."""
    candidates = [root / KINDS[kind].folder / f"{name}.toml" for root in library.folders]
    there = [path for path in candidates if path.is_file()]
    return next((path for path in there if not is_of(path, _COMMAND)), there[0])


def local_profiles(
    changes: Sequence[ProfileChange], source: ReadingSource, library: Library, out: Path
) -> list[MeasuredProfile]:
    """Profiles of the materials and printers that were measured, checked but not written.

    Quantities that an earlier run of the command measured and this one did not are kept. Raises InputError if a file of
    a profile's name was not written by the command."""
    profiles = []
    for kind, name in dict.fromkeys((change.kind, change.name) for change in changes):
        path = out / KINDS[kind].folder / f"{name}.toml"
        here = [change for change in changes if (change.kind, change.name) == (kind, name)]
        there = check_ours(path, ", ".join(".".join(change.keys) for change in here))
        content = read_toml(base_file(kind, name, library))
        if there:
            _carry(read_toml(path), content)
        changed = tuple(_put(content, change, path) for change in here)
        KINDS[kind].validate(content, str(path))
        text = head(source, "the shipped profile with the measured numbers") + toml_text(content)
        profiles.append(MeasuredProfile(path, text, changed))
    return profiles


def head(source: ReadingSource, what: str) -> str:
    """First lines of a profile that the command writes."""
    return whole_head(_COMMAND, f"{source.where} ({source.lab}, {source.date.isoformat()}): {what}")


def write_profiles(profiles: Sequence[MeasuredProfile]) -> None:
    """Write every profile, or none. Raises InputError if a folder cannot be written."""
    replace_files({profile.path: profile.text.encode() for profile in profiles})


def check_ours(path: Path, keys: str) -> bool:
    """True if the command wrote the file, False if there is none. Raises InputError for another's file; ``keys`` are to
    go in."""
    remedy = f"put {keys} into it by hand, move it away, or give another folder with `out`"
    return check_of(path, _COMMAND, remedy)


def _carry(earlier: dict[str, Any], content: dict[str, Any]) -> None:
    """Copy the quantities of an earlier profile that were measured on coupons into ``content``."""
    for key, value in earlier.items():
        if not isinstance(value, dict):
            continue
        if MARK in str(value.get("source", "")):
            content[key] = value
        elif isinstance(content.get(key), dict):
            _carry(value, content[key])


def _put(content: dict[str, Any], change: ProfileChange, path: Path) -> ChangedQuantity:
    """Put a measured quantity into ``content``; return its old and new value."""
    *tables, last = change.keys
    owner = content
    for table in tables:
        owner = owner[table]
    before = owner.get(last)
    owner[last] = change.content
    return ChangedQuantity(str(path), ".".join(change.keys), before, change.content)


def local_curve(
    pair: str,
    measured: Sequence[MixedCoupons],
    source: ReadingSource,
    library: Library,
    out: Path,
    results: CouponFindings,
) -> MeasuredProfile | None:
    """The lab's mixing curve of a pair, checked but not written; None if nothing was measured.

    Figures and notes go to ``results``. Raises InputError for unknown resins, for moduli that do not rise with the
    fraction, and if a curve of that name was not written by the command."""
    where = f"{source.where}: mixing"
    soft_name, stiff_name = resins_of(pair, file=source.where, key="mixing")
    pair = f"{soft_name}+{stiff_name}"
    soft: Material = library.load("materials", soft_name, file=source.where, key="mixing")
    stiff: Material = library.load("materials", stiff_name, file=source.where, key="mixing")
    if soft.kind != "elastomer":
        raise InputError(f"{where}.{pair}: {soft.label} is rigid; write the soft resin first, SOFT+STIFF")
    known = stiffness(pair, soft, stiff, measured, source)
    if not known:
        return None
    if known[-1].fraction == 0:
        raise InputError(
            f"{where}.{pair}: readings at fraction = 0 alone make no curve; enter them as {soft_name}'s own"
        )
    curve = _curve(soft_name, stiff_name, known, source)
    content = curve.model_dump(exclude_none=True)
    path = out / KINDS["mixing"].folder / f"{pair}.toml"
    check_ours(path, f"points of {', '.join(f'{point.fraction:g}' for point in known)}")
    KINDS["mixing"].validate(content, str(path))
    results.figures += [
        MeasuredFigure(
            f"{pair}, {100 * point.fraction:g} %",
            f"shear modulus, MPa ({point.by})",
            point.modulus,
            point.spread,
            point.count,
        )
        for point in known
    ]
    results.notes.append(
        f"{pair}: elongation at break was not measured; add elongation_at_break_percent to the points, or no "
        "prediction has a break strain of a mixed wall"
    )
    first = head(replace(source, where=file_name(Path(source.where).name)), "the mixing curve as measured")
    return MeasuredProfile(path, first + toml_text(content), _changes(path, curve, pair, library))


def _curve(soft: str, stiff: str, known: Sequence[MixModulus], source: ReadingSource) -> MixingCurve:
    points = [point.point(source) for point in known]
    if known[0].fraction > 0:
        said = "the soft resin as the catalogue has it"
        points.insert(0, MixingPoint.model_construct(fraction=0.0, material=soft, source=said))
    return MixingCurve.model_construct(
        title=f"{soft} with {stiff}, measured",
        soft=soft,
        stiff=stiff,
        assumption=f"{MARK} of known fractions at {len(known)} points, {source.lab}, {source.date.isoformat()}; "
        "a monotone curve between them",
        points=points,
    )


def _changes(path: Path, curve: MixingCurve, pair: str, library: Library) -> tuple[ChangedQuantity, ...]:
    """Measured points of a curve, each beside the modulus of the curve that was in force before, None without one."""
    before = mixing(curve.soft, curve.stiff, library) if pair in library.paths("mixing") else None
    rows = []
    for point in curve.points:
        if point.shear_modulus_MPa is None:
            continue
        old = None
        if before is not None and point.fraction <= before.fraction[-1]:
            old = {"value": rounded(float(before.modulus_at(np.asarray(point.fraction))), DIGITS)}
        new = {"value": point.shear_modulus_MPa, "source": point.source}
        rows.append(ChangedQuantity(str(path), f"shear_modulus_MPa at {100 * point.fraction:g} %", old, new))
    return tuple(rows)


def enter_results(path: Path, out: Path | None = None, library: Library | None = None) -> CouponReport:
    """Read a results file, compute, and write local profiles under ``out``, else in the user's folder.

    Raises InputError for a bad file, for one without readings, and if a profile to be written has a file that the
    command did not write."""
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
    return CouponReport(
        lab=results.lab,
        date=results.date.isoformat(),
        written=tuple(str(profile.path) for profile in profiles),
        changes=tuple(change for profile in profiles for change in profile.changes),
        figures=tuple(findings.figures),
        notes=tuple(findings.notes),
    )


def evaluate_results(results: CouponResults, where: str, library: Library) -> CouponFindings:
    """Figures, notes and changed quantities of a results file; ``where`` is its path, for messages."""
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
    """Profile as it was before the command wrote one of its name. Raises InputError if the name is unknown."""
    library.load(kind, name, file=file, key=key)
    path = base_file(kind, name, library)
    return KINDS[kind].validate(read_toml(path), str(path))


def _design(name: str, where: str, library: Library) -> str:
    if name not in library.paths("designs"):
        library.load("designs", name, file=where, key="leak-cap or volume-plug")
    return name
