"""``pneutouch show``: what a 3MF or a voxel stack holds; and ``pneutouch list``: what the library holds."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from pneutouch.cli.app import JsonOption, app, print_answer, refuse_flags
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import filled_text, table_text
from pneutouch.errors import InputError
from pneutouch.results.stored import ShownPackage, ShownRecipe, ShownStack
from pneutouch.spec.toml_text import flat

parameter = parameters_of(__file__)


@app.command()
def show(
    context: typer.Context,
    file: Annotated[Path, parameter("file")],
    out: Annotated[Path | None, parameter("out")] = None,
    json: JsonOption = False,
) -> None:
    """Show a 3MF: its bodies, its metadata and the recipe it was built from. Of a voxel stack: what lies in it."""
    if file.is_dir() and file.suffix.lower() != ".3mf":
        from pneutouch.workflows.show import show_stack

        stack = show_stack(file, out)
        held = {"stack": stack.stack, "resins": stack.resins, **stack.held}
        print_answer(held, lambda held: stack_text(stack), json=json)
    else:
        from pneutouch.workflows.show import show as run

        refuse_flags(context, {"out": "--out"}, "a 3MF, which has no sections", str(file))
        print_answer(run(file), show_text, json=json)


@app.command("list")
def list_(kind: Annotated[str | None, parameter("kind")] = None, json: JsonOption = False) -> None:
    """List designs, pads, specimens, examples, calibrations, materials, mixing curves, printers, gauges and parts."""
    from pneutouch.catalogue.listing import listing

    content = listing(kind)
    print_answer(content, listing_text, json=json)
    broken = [entry["file"] for entries in content.values() for entry in entries if "error" in entry]
    if broken:
        remedy = "mend or move it" if len(broken) == 1 else "mend or move them"
        raise InputError(f"cannot be read: {', '.join(broken)}", remedy=remedy)


NO_RECIPE = "no recipe: it cannot be built again"
OF_A_JOB = "no recipe: one print job; to build again, take the design's own 3MF, beside the folder jobs"


def show_text(package: ShownPackage) -> str:
    """Bodies, metadata and recipe, one block each; control characters of foreign files are left out."""
    own = package.metadata.get("Application", "").startswith("pneutouch")
    recipe = [OF_A_JOB if own else NO_RECIPE] if package.recipe is None else _recipe(package.recipe)
    blocks = [_bodies(package), _table("metadata", package.metadata), *recipe]
    lines = "\n\n".join(block for block in blocks if block).split("\n")
    return "\n".join("".join(letter for letter in line if letter.isprintable()) for line in lines)


def stack_text(stack: ShownStack) -> str:
    """A voxel stack: its raster, its resins as counted, its bodies as the manifest has them."""
    held = stack.held
    resins = [
        [
            name,
            ", ".join(map(str, resin.rgba)),
            str(resin.voxels),
            f"{resin.volume_mm3:.2f}",
            f"{resin.share_of_the_print:.3%}",
        ]
        for name, resin in stack.resins.items()
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
        for name, body in held["bodies"].items()
    ]
    return filled_text(
        "stack.txt.j2",
        name=stack.stack,
        held=held,
        resins=table_text(["resin", "RGBA", "voxels", "volume mm3", "share"], resins),
        bodies=table_text(["body", "voxels", "volume mm3", "off exact", "dithered in", "designed", "realised"], bodies),
    )


def _bodies(package: ShownPackage) -> str:
    head = ["body", "material", "colour", "size mm", "volume mm3", "triangles"]
    rows = [
        [
            body.name or "-",
            body.material or "-",
            body.colour or "-",
            " x ".join(f"{length:.2f}" for length in body.size_mm),
            f"{body.volume_mm3:.1f}",
            str(body.triangles),
        ]
        for body in package.bodies
    ]
    mixes = [
        f"{body.name} is mixed from " + ", ".join(f"{ratio:.1%} {resin}" for resin, ratio in body.mix.items())
        for body in package.bodies
        if body.mix
    ]
    count = len(rows)
    bodies, thumbnail = "body" if count == 1 else "bodies", "with" if package.thumbnail else "no"
    about = f"{package.file}: {count} {bodies}, {thumbnail} thumbnail"
    warned = [f"warning: {text}" for text in package.warnings]
    return "\n".join([about, *warned, "", table_text(head, _flat(rows)), *mixes])


def _recipe(recipe: ShownRecipe) -> list[str]:
    inputs = recipe.inputs
    design = {key: value for key, value in flat(inputs["design"]).items() if value is not None}
    settings = {key: inputs[key] for key in ("model", "closure", "clamp", "tolerance") if inputs[key] is not None}
    libraries = [f"{name} {version}" for name, version in recipe.versions.items() if name != "pneutouch"]
    made = {
        "made by": f"pneutouch {recipe.version}",
        "made with": ", ".join(libraries) or "-",
        "input hash": recipe.input_hash,
        **({"other versions": ", ".join(recipe.other_versions)} if recipe.other_versions else {}),
        **settings,
        "compared resins": ", ".join(inputs["compared_resins"]),
    }
    return [_table(f"recipe of {recipe.name}", made), _table("design", design)]


def _table(title: str, content: Mapping[str, object]) -> str:
    rows = [
        [key, ", ".join(f"{x}" for x in value) if isinstance(value, list) else str(value)]
        for key, value in content.items()
    ]
    return f"{title}\n" + table_text([], _flat(rows), indent="  ") if rows else ""


def _flat(rows: list[list[str]]) -> list[list[str]]:
    """Cells on one line each."""
    return [[" ".join(cell.split()) for cell in row] for row in rows]


def listing_text(content: dict[str, list[dict[str, str]]]) -> str:
    """The lists by kind as text, each name with its title."""
    blocks = []
    for group, entries in content.items():
        rows = [[entry["name"], *([entry["kind"]] if "kind" in entry else []), _titled(entry)] for entry in entries]
        blocks.append(f"{group}\n" + (table_text([], rows, indent="  ") or "  none"))
    return "\n\n".join(blocks)


def _titled(entry: dict[str, str]) -> str:
    """The title of an entry, or the error in its file, on one line."""
    return entry["title"] if "error" not in entry else f"cannot be read: {entry['error'].partition(chr(10))[0]}"
