"""The lab's own mixing curve, from coupons of two resins mixed in known fractions."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneutouch.bench.finding import MARK, CouponFindings, MeasuredFigure, ReadingSource
from pneutouch.bench.mixing import MixModulus, stiffness
from pneutouch.catalogue import KINDS, Library
from pneutouch.catalogue.mixture import mixing
from pneutouch.errors import InputError
from pneutouch.spec.coupon import MixedCoupons
from pneutouch.spec.material import Material
from pneutouch.spec.names import file_name
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.coupons.blends import resins_of
from pneutouch.workflows.coupons.profile import MeasuredProfile, check_ours, head


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
    fraction, and where a curve of that name was not written by the command.
    """
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
    content = _curve(pair, soft_name, stiff_name, known, source)
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
        "prediction "
        "has a break strain of a mixed wall"
    )
    text = head(replace(source, where=file_name(Path(source.where).name)), "the mixing curve as measured") + toml_text(
        content
    )
    return MeasuredProfile(path, text, _changes(path, content, pair, library))


def _curve(pair: str, soft: str, stiff: str, known: Sequence[MixModulus], source: ReadingSource) -> dict[str, Any]:
    points = [point.content(source) for point in known]
    if known[0].fraction > 0:
        points.insert(0, {"fraction": 0.0, "material": soft, "source": "the soft resin as the catalogue has it"})
    return {
        "title": f"{soft} with {stiff}, measured",
        "soft": soft,
        "stiff": stiff,
        "assumption": f"{MARK} of known fractions at {len(known)} points, {source.lab}, {source.date.isoformat()}; "
        "a monotone curve between them",
        "points": points,
    }


def _changes(path: Path, content: dict[str, Any], pair: str, library: Library) -> list[dict[str, Any]]:
    """Every point, compared with the curve that was in force before."""
    before = None
    if pair in library.paths("mixing"):
        before = mixing(content["soft"], content["stiff"], library)
    rows = []
    for point in content["points"]:
        if "shear_modulus_MPa" not in point:
            continue
        fraction = point["fraction"]
        old = None
        if before is not None and fraction <= before.fraction[-1]:
            old = {"value": float(f"{float(before.modulus_at(fraction)):.4g}")}
        rows.append(
            {
                "file": str(path),
                "key": f"shear_modulus_MPa at {100 * fraction:g} %",
                "before": old,
                "after": {"value": point["shear_modulus_MPa"], "source": point["source"]},
            }
        )
    return rows
