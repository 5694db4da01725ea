"""The content of a 3MF as text."""

from __future__ import annotations

from typing import Any

from pneutouch.cli.text import columns

NO_RECIPE = "no recipe: not built by pneutouch, so it can be shown but not rebuilt"


def show_text(document: dict[str, Any]) -> str:
    """Bodies, metadata and recipe, one block each; control characters of foreign files are left out."""
    blocks = [_bodies(document), _table("metadata", document["metadata"]), *_recipe(document["recipe"])]
    lines = "\n\n".join(block for block in blocks if block).split("\n")
    return "\n".join("".join(letter for letter in line if letter.isprintable()) for line in lines)


def _bodies(document: dict[str, Any]) -> str:
    head = ["body", "material", "colour", "size mm", "volume mm3", "triangles"]
    rows = [
        [
            body["name"] or "-", body["material"] or "-", body["colour"] or "-",
            " x ".join(f"{length:.2f}" for length in body["size_mm"]), f"{body['volume_mm3']:.1f}", str(body["triangles"]),
        ]
        for body in document["bodies"]
    ]  # fmt: skip
    mixes = [
        f"{body['name']} is mixed from " + ", ".join(f"{ratio:.1%} {resin}" for resin, ratio in body["mix"].items())
        for body in document["bodies"]
        if body["mix"]
    ]
    count = len(rows)
    about = f"{document['file']}: {count} {'body' if count == 1 else 'bodies'}, {'with' if document['thumbnail'] else 'no'} thumbnail"
    warned = [f"warning: {text}" for text in document["warnings"]]
    return "\n".join([about, *warned, "", columns(head, _flat(rows)), *mixes])


def _recipe(recipe: dict[str, Any] | None) -> list[str]:
    if recipe is None:
        return [NO_RECIPE]
    inputs = recipe["inputs"]
    design = {
        f"{table}.{key}": value
        for table, content in inputs["design"].items()
        for key, value in content.items()
        if value is not None
    }
    settings = {key: inputs[key] for key in ("model", "closure", "clamp", "tolerance") if inputs[key] is not None}
    other = recipe["other_versions"]
    libraries = [f"{name} {version}" for name, version in recipe["versions"].items() if name != "pneutouch"]
    made = {
        "made by": f"pneutouch {recipe['version']}", "made with": ", ".join(libraries) or "-", "input hash": recipe["input_hash"],
        **({"other versions": ", ".join(other)} if other else {}),
        **settings, "compared resins": ", ".join(inputs["compared_resins"]),
    }  # fmt: skip
    return [_table(f"recipe of {recipe['name']}", made), _table("design", design)]


def _table(title: str, content: dict[str, Any]) -> str:
    rows = [
        [key, ", ".join(f"{x}" for x in value) if isinstance(value, list) else str(value)]
        for key, value in content.items()
    ]
    return f"{title}\n" + columns([], _flat(rows), indent="  ") if rows else ""


def _flat(rows: list[list[str]]) -> list[list[str]]:
    """Cells on one line each."""
    return [[" ".join(cell.split()) for cell in row] for row in rows]
