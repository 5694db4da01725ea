"""The locked dependencies as a CycloneDX document (version 1.6): ``make sbom``.

Names, versions, hashes and who requires what come from requirements.lock, licences from the metadata of what is
installed. It holds neither a time nor a serial number: the same lock file in the same environment gives the same bytes.
It is written here and not by cyclonedx-py, which reads either a file of requirements, without licences, or an
environment, without hashes.
"""

from __future__ import annotations

import importlib.metadata
import json
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import pneutouch

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "requirements.lock"
SPEC = "1.6"

_ENTRY = re.compile(r"(?P<name>[a-z0-9._-]+)==(?P<version>[^ ;]+)(?: ; (?P<marker>.+?))? \\")
_HASH = re.compile(r"    --hash=sha256:([0-9a-f]{64})(?: \\)?")
_VIA = re.compile(r"    # +(?:via +)?(?P<name>(?:-r )?[\w.-]+)(?: \(pyproject.toml\))?")
_DIRECT = "pneutouch"


def locked(text: str) -> list[dict[str, Any]]:
    """Entries of a lock file: name, version, marker, hashes, and what requires them (``via``)."""
    entries: list[dict[str, Any]] = []
    for line in text.splitlines():
        if match := _ENTRY.fullmatch(line):
            entries.append({**match.groupdict(), "hashes": [], "via": set()})
        elif line.strip() == "# via":
            continue
        elif match := _HASH.fullmatch(line):
            entries[-1]["hashes"].append(match[1])
        elif match := _VIA.fullmatch(line):
            who = match["name"]
            # What builds the package itself is required by a file of its product.
            entries[-1]["via"].add(_DIRECT if who.startswith("-r ") else who)
        else:
            raise ValueError(f"{LOCK}: not understood: {line}")
    return entries


def purl(name: str, version: str) -> str:
    """The package URL, which is the reference inside the document as well."""
    return f"pkg:pypi/{name}@{version}"


def licences(name: str) -> list[dict[str, Any]]:
    """What the installed metadata states: an expression, else classifiers, else a short text; or nothing."""
    try:
        about = importlib.metadata.metadata(name)
    except importlib.metadata.PackageNotFoundError:
        return []
    if expression := about.get("License-Expression"):
        return [{"expression": expression}]
    classified = [c.rpartition(" :: ")[2] for c in about.get_all("Classifier", []) if c.startswith("License :: ")]
    stated = sorted({each for each in classified if each != "OSI Approved"})
    if not stated and len(text := (about.get("License") or "").strip()) in range(1, 65) and "\n" not in text:
        stated = [text]
    return [{"license": {"name": each}} for each in stated]


def component(entry: dict[str, Any]) -> dict[str, Any]:
    """A component of CycloneDX; the hashes are those of its files at PyPI."""
    name, version = entry["name"], entry["version"]
    files = {
        "type": "distribution",
        "url": f"https://pypi.org/project/{name}/{version}/#files",
        "hashes": [{"alg": "SHA-256", "content": each} for each in sorted(entry["hashes"])],
    }
    content: dict[str, Any] = {"type": "library", "bom-ref": purl(name, version), "name": name, "version": version}
    content |= {"purl": purl(name, version), "externalReferences": [files]}
    if known := licences(name):
        content["licenses"] = known
    if entry["marker"]:
        content["properties"] = [{"name": "pneutouch:environment-marker", "value": entry["marker"].strip()}]
    return content


def document() -> dict[str, Any]:
    """The whole document."""
    entries = sorted(locked(LOCK.read_text(encoding="utf-8")), key=lambda one: (one["name"], one["version"]))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    product = purl(_DIRECT, pneutouch.__version__)
    needs: dict[str, set[str]] = {product: set(), **{purl(one["name"], one["version"]): set() for one in entries}}
    # A name may be locked in several versions, for several Pythons.
    versions = {_DIRECT: [product]}
    for one in entries:
        versions.setdefault(one["name"], []).append(purl(one["name"], one["version"]))
    for one in entries:
        for who in (each for name in one["via"] for each in versions[name]):
            needs[who].add(purl(one["name"], one["version"]))
    return {
        "$schema": f"http://cyclonedx.org/schema/bom-{SPEC}.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": SPEC,
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": product,
                "name": _DIRECT,
                "version": pneutouch.__version__,
                "purl": product,
                "licenses": [{"expression": project["license"]}],
            }
        },
        "components": [component(one) for one in entries],
        "dependencies": [
            {"ref": one, **({"dependsOn": sorted(of)} if of else {})} for one, of in sorted(needs.items())
        ],
    }


def main(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    content = document()
    path.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    silent = [one["name"] for one in content["components"] if "licenses" not in one]
    print(f"{path}: {len(content['components'])} components; without a stated licence: {', '.join(silent) or 'none'}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "dist/pneutouch.cdx.json"))
