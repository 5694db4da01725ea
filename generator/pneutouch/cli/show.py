"""``pneutouch show``: what a 3MF or a voxel stack holds.

The content of a 3MF or of a voxel stack as text.
"""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import JsonOption, app, print_json, refuse_flags, reporting
from pneutouch.cli.terminal import echo, table_text


@app.command()
def show(
    context: typer.Context,
    file: Annotated[
        Path, typer.Argument(metavar="FILE.3mf", help="A 3MF, ours or not; or the folder of a voxel stack.")
    ],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.png", help="Picture of a voxel stack's sections.")
    ] = None,
    json: JsonOption = False,
) -> None:
    """Show a 3MF: its bodies, its metadata and the recipe it was built from. Of a voxel stack: what lies in it."""
    with reporting():
        if file.is_dir() and file.suffix.lower() != ".3mf":
            from pneutouch.workflows.show import show_stack

            document, text = show_stack(file, out), stack_text
        else:
            from pneutouch.workflows.show import show as run

            refuse_flags(context, {"out": "--out"}, "a 3MF, which has no sections", str(file))
            document, text = run(file), show_text
        if json:
            print_json(document)
        else:
            echo(text(document))


NO_RECIPE = "no recipe: not built by pneutouch, so it can be shown but not rebuilt"


def show_text(document: dict[str, Any]) -> str:
    """Bodies, metadata and recipe, one block each; control characters of foreign files are left out."""
    blocks = [_bodies(document), _table("metadata", document["metadata"]), *_recipe(document["recipe"])]
    lines = "\n\n".join(block for block in blocks if block).split("\n")
    return "\n".join("".join(letter for letter in line if letter.isprintable()) for line in lines)


def stack_text(document: dict[str, Any]) -> str:
    """A voxel stack: its raster, its resins as counted, its bodies as the manifest has them."""
    wide, tall = document["pixels"]
    x, y, z = document["size_mm"]
    about = (
        f"{document['stack']}: {document['layers']} slices of {wide} x {tall} pixels, {x:.2f} x {y:.2f} x {z:.2f} mm; "
        f"{document['dpi'][0]} x {document['dpi'][1]} dpi, {document['layer_um']:g} um layers"
    )
    machine = f"for the {document['printer']} in the mode {document['mode']}" if "printer" in document else ""
    resins = [
        [
            resin,
            ", ".join(map(str, entry["rgba"])),
            str(entry["voxels"]),
            f"{entry['volume_mm3']:.2f}",
            f"{entry['share_of_the_print']:.3%}",
        ]
        for resin, entry in document["resins"].items()
    ]
    bodies = [
        [
            name,
            str(body["voxels"]),
            f"{body['volume_mm3']:.2f}",
            f"{body['volume_mm3'] / body['exact_volume_mm3'] - 1:+.2%}",
            body.get("stiff_resin", "-"),
            *(f"{body[key]:.3%}" if key in body else "-" for key in ("fraction_requested", "fraction_realised")),
        ]
        for name, body in document["bodies"].items()
    ]
    return "\n".join(
        [
            about,
            *([machine] if machine else []),
            "",
            table_text(["resin", "RGBA", "voxels", "volume mm3", "share"], resins),
            "",
            table_text(["body", "voxels", "volume mm3", "off exact", "dithered in", "designed", "realised"], bodies),
            "",
            *(f"assumed: {line}" for line in document.get("assumptions", [])),
        ]
    )


def _bodies(document: dict[str, Any]) -> str:
    head = ["body", "material", "colour", "size mm", "volume mm3", "triangles"]
    rows = [
        [
            body["name"] or "-",
            body["material"] or "-",
            body["colour"] or "-",
            " x ".join(f"{length:.2f}" for length in body["size_mm"]),
            f"{body['volume_mm3']:.1f}",
            str(body["triangles"]),
        ]
        for body in document["bodies"]
    ]
    mixes = [
        f"{body['name']} is mixed from " + ", ".join(f"{ratio:.1%} {resin}" for resin, ratio in body["mix"].items())
        for body in document["bodies"]
        if body["mix"]
    ]
    count = len(rows)
    bodies, thumbnail = "body" if count == 1 else "bodies", "with" if document["thumbnail"] else "no"
    about = f"{document['file']}: {count} {bodies}, {thumbnail} thumbnail"
    warned = [f"warning: {text}" for text in document["warnings"]]
    return "\n".join([about, *warned, "", table_text(head, _flat(rows)), *mixes])


def _recipe(recipe: dict[str, Any] | None) -> list[str]:
    if recipe is None:
        return [NO_RECIPE]
    inputs = recipe["inputs"]
    design = {key: value for key, value in inputs["design"].items() if not isinstance(value, dict)} | {
        f"{table}.{key}": value
        for table, content in inputs["design"].items()
        if isinstance(content, dict)
        for key, value in content.items()
    }
    design = {key: value for key, value in design.items() if value is not None}
    settings = {key: inputs[key] for key in ("model", "closure", "clamp", "tolerance") if inputs[key] is not None}
    other = recipe["other_versions"]
    libraries = [f"{name} {version}" for name, version in recipe["versions"].items() if name != "pneutouch"]
    made = {
        "made by": f"pneutouch {recipe['version']}",
        "made with": ", ".join(libraries) or "-",
        "input hash": recipe["input_hash"],
        **({"other versions": ", ".join(other)} if other else {}),
        **settings,
        "compared resins": ", ".join(inputs["compared_resins"]),
    }
    return [_table(f"recipe of {recipe['name']}", made), _table("design", design)]


def _table(title: str, content: dict[str, Any]) -> str:
    rows = [
        [key, ", ".join(f"{x}" for x in value) if isinstance(value, list) else str(value)]
        for key, value in content.items()
    ]
    return f"{title}\n" + table_text([], _flat(rows), indent="  ") if rows else ""


def _flat(rows: list[list[str]]) -> list[list[str]]:
    """Cells on one line each."""
    return [[" ".join(cell.split()) for cell in row] for row in rows]
