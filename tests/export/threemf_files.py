"""3MF files for tests: read strictly by lib3mf itself, and altered in the ways that a hostile file is."""

from __future__ import annotations

import base64
import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lib3mf

from pneutouch.output.files import input_hash

MODEL = "3D/3dmodel.model"


def read_strictly(path: Path) -> tuple[Any, Any]:
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    return model, reader


def parts_of(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def write_parts(path: Path, parts: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return path


def with_model(source: Path, target: Path, change: Callable[[bytes], bytes]) -> Path:
    """``source`` with its model part changed."""
    parts = parts_of(source)
    return write_parts(target, {**parts, MODEL: change(parts[MODEL])})


def with_metadata(source: Path, target: Path, **values: str) -> Path:
    """``source`` with the text of short metadata entries of ours replaced; ``input_hash`` stands for input-hash."""

    def change(model: bytes) -> bytes:
        text = model.decode()
        for key, value in values.items():
            plain = set(value) <= {"["}
            stored = value if plain else base64.b64encode(value.encode()).decode()
            assert len(stored) < 65_000
            kind = "" if plain else ' type="xs:base64Binary"'
            pattern = rf'(<metadata name="\w+:{key.replace("_", "-")}")[^>]*>.*?(</metadata>)'
            text, count = re.subn(pattern, lambda m, v=f"{kind}>{stored}": m[1] + v + m[2], text, flags=re.DOTALL)
            assert count == 1, key
        return text.encode()

    return with_model(source, target, change)


def recipe_in(path: Path) -> dict[str, Any]:
    (found,) = re.findall(r':recipe"[^>]*>(.*?)</metadata>', parts_of(path)[MODEL].decode(), re.DOTALL)
    recipe: dict[str, Any] = json.loads(base64.b64decode(found))
    return recipe


def with_recipe(source: Path, target: Path, change: Callable[[dict[str, Any]], object], *, rehash: bool = True) -> Path:
    """``source`` with its recipe changed, and the hash beside it made to agree as a forger would."""
    recipe = recipe_in(source)
    change(recipe)
    values = {"recipe": json.dumps(recipe, separators=(",", ":"))}
    if rehash:
        values["input_hash"] = input_hash(recipe.get("inputs", {}), recipe.get("version", ""))
    return with_metadata(source, target, **values)
