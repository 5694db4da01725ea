"""The manifest of an output folder: its inputs, the versions that made it, and the digest of every file in it."""

import importlib.metadata
from collections.abc import Mapping
from typing import Any

from pneutouch import __version__
from pneutouch.formats import versioned
from pneutouch.output.files import MANIFEST, digest, json_bytes

LIBRARIES = ("numpy", "manifold3d", "trimesh", "lib3mf", "cadquery", "cadquery-ocp", "matplotlib", "jinja2", "typst")
"""Libraries whose versions the bytes of a build depend on."""

_DIGITS = 12
"""Digits of an input hash."""


def input_hash(inputs: Mapping[str, Any], version: str = __version__) -> str:
    """Short digest of the inputs and the version."""
    return short_digest({"inputs": inputs, "version": version})


def short_digest(document: Mapping[str, Any]) -> str:
    """First twelve digits of the SHA-256 of a JSON document."""
    return digest(json_bytes(document))[:_DIGITS]


def versions() -> dict[str, str]:
    """The versions that the bytes of a build depend on; an extra that is not installed is left out."""
    installed = {name: version for name in LIBRARIES if (version := _installed(name)) is not None}
    return {"pneutouch": __version__, **installed}


def _installed(library: str) -> str | None:
    try:
        return importlib.metadata.version(library)
    except importlib.metadata.PackageNotFoundError:
        return None


def entry(content: bytes) -> dict[str, Any]:
    """Entry of a file in a manifest."""
    return {"sha256": digest(content), "bytes": len(content)}


def with_manifest(files: Mapping[str, bytes], name: str, inputs: Mapping[str, Any], **more: Any) -> dict[str, bytes]:
    """The files of a folder and their manifest. ``more`` are further entries; an ``input_hash`` among them is kept."""
    listed = {path: entry(content) for path, content in sorted(files.items())}
    return {**files, MANIFEST: manifest(listed, name, inputs=inputs, **{"input_hash": input_hash(inputs), **more})}


def manifest(listed: Mapping[str, Mapping[str, Any]], name: str, **more: Any) -> bytes:
    """The manifest of files whose entries (see `entry`) are given by path."""
    return json_bytes(versioned("manifest", {"name": name, "versions": versions(), "files": listed, **more}))
