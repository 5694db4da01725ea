"""Write a set of coupons: STL, 3MF, the print-and-measure sheet, the results file to fill in, and a manifest."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.body import Body
from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.export.scene import stl
from pneutouch.export.threemf import threemf
from pneutouch.output.files import check_writable, digest, stated_digest, write_folder
from pneutouch.output.manifest import input_hash, with_manifest
from pneutouch.spec.files import read_bytes
from pneutouch.workflows.coupons.lay import CouponPiece, lay
from pneutouch.workflows.coupons.order import CouponOptions, CouponOrder, order
from pneutouch.workflows.coupons.sheet import sheet, stl_name
from pneutouch.workflows.coupons.template import results_template

RESULTS, SHEET = "results.toml", "measure.md"


def build_coupons(options: CouponOptions, out: Path, library: Library | None = None) -> tuple[Path, dict[str, Any]]:
    """Write the coupons into ``out/coupons-<printer>/``; the folder and its content, as data.

    Raises InputError for what is unknown or does not fit the tray, and where readings in the folder would be lost.
    The same input gives the same bytes.
    """
    ordered = order(options, library)
    folder = out / ordered.name
    check_writable(folder)
    _check_unfilled(folder)
    trays = {name: lay(name, items) for name, items in ordered.machines().items()}
    files: dict[str, bytes] = {}
    for name, pieces in trays.items():
        bodies = tuple(body for piece in pieces for body in piece.copies())
        title = ordered.name if name == ordered.profile else name
        files[f"{title}.3mf"] = threemf(title, bodies, _metadata(ordered, name, bodies))
        files |= {f"stl/{stl_name(piece, ordered)}": stl(piece.body) for piece in pieces}
    files[SHEET] = sheet(ordered, trays).encode()
    files[RESULTS] = results_template(ordered).encode()
    coupons = _coupons(trays)
    write_folder(folder, with_manifest(files, ordered.name, inputs(ordered), coupons=coupons))
    return folder, {"name": ordered.name, "coupons": coupons}


def inputs(ordered: CouponOrder) -> dict[str, Any]:
    """Everything that the coupons depend on, as data."""
    scene = ordered.scene
    return {
        "profile": ordered.profile,
        "design": None if scene is None else scene.design.model_dump(mode="json"),
        "items": [
            {
                "coupon": item.coupon.name,
                "about": item.about,
                "copies": item.copies,
                "printer": item.printer_name,
                "material": item.material.model_dump(mode="json"),
                **({} if item.mould is None else {"mould": item.mould.model_dump(mode="json")}),
            }
            for item in ordered.items
        ],
        "printers": {name: items[0].printer.model_dump(mode="json") for name, items in ordered.machines().items()},
    }


def _check_unfilled(folder: Path) -> None:
    """Refuse to write over a results file that a user has filled in."""
    path = folder / RESULTS
    if not path.is_file():
        return
    if digest(read_bytes(path)) != stated_digest(folder, RESULTS):
        raise InputError(f"{path} has been filled in", key="out", remedy="move it away first, or give another folder")


def _metadata(ordered: CouponOrder, name: str, bodies: tuple[Body, ...]) -> dict[str, str]:
    return {
        "Title": f"Coupons for {name}",
        "Application": f"pneutouch {__version__}",
        "Description": f"{len(bodies)} coupons to print and measure; see {SHEET}",
        "input-hash": input_hash(inputs(ordered)),
    }


def _coupons(trays: Mapping[str, tuple[CouponPiece, ...]]) -> list[dict[str, Any]]:
    return [
        {
            "coupon": piece.item.coupon.name,
            "piece": piece.body.name,
            "material": piece.solid.material.title,
            "printer": name,
            "copies": len(piece.places),
            "places_mm": [list(place) for place in piece.places],
            "size_mm": [round(length, 3) for length in piece.size],
            "exact_volume_mm3": round(piece.solid.volume, 3),
            "volume_mm3": round(piece.body.volume, 3),
            "measured_deviation_mm": round(piece.deviation, 6),
        }
        for name, pieces in trays.items()
        for piece in pieces
    ]
