"""The page of every print rule, with a picture of a good and of a bad case and what the rule finds in the bad one.

The pictures and findings are those that ``make rule-pictures`` writes.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

from pneutouch.printability.rulebook import MOULD_RULES, RULES
from pneutouch.printability.rules import feature_sizes, resins
from pneutouch.spec.printer import FeatureSize, Printer
from reference_pages import markdown
from reference_pages.markdown import code, plain, table
from reference_pages.printers import printers

_FILE = Path(__file__).with_name("rules.toml")
PICTURES = Path(__file__).parents[2] / "reference/rules"

GROUPS = {
    "Bodies as they are printed": ("mesh", "contact faces", "envelope", "resins"),
    "Features": ("walls", "pins", "holes", "channels", "gaps", "emboss", "edges"),
    "Support": ("hollows", "cleaning", "matte"),
    "The membrane and its working": ("layers", "glue", "inserts", "gland", "driving", "mixing curve", "freedom"),
    "Casting": ("filling", "bubbles", "inhibition", *MOULD_RULES),
    "On request": (resins.VOXELS, "deep"),
}
"""The rules in the order of the page."""

NAMES = (*RULES, *MOULD_RULES, resins.VOXELS, "deep")
"""Every rule: those of each check, those on moulds, on voxel stacks and of the independent reader."""

_LIMITS = {**{name: rule.limit for name, rule in feature_sizes.SIZE_RULES.items()}, "gaps": "gap"}
"""Limits of the printers that rules compare with."""

_INTRO = (
    "Every rule that `pneutouch check` and `pneutouch build` apply to the bodies as they will be printed, with a case "
    "that passes and one that does not. An *error* ends a command with exit code 1; a *warning* and a *note* do not. "
    "The findings are what the rules report of the geometry that is shown. How to mend a design is on "
    "[Printing](../../howto/printing.md)."
)


def page() -> str:
    """The page. Raises KeyError for a rule without a text or findings, FileNotFoundError for one without a picture."""
    texts = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    record = json.loads((PICTURES / "findings.json").read_text(encoding="utf-8"))
    listed = [name for names in GROUPS.values() for name in names]
    assert sorted(listed) == sorted(NAMES), set(listed) ^ set(NAMES)
    rows = [(f"[{name}](#{anchor(name)})", plain(texts[name]["requires"])) for name in listed]
    groups = [
        "\n\n".join([f"## {group}", *(section(name, texts[name], record[name]) for name in names)])
        for group, names in GROUPS.items()
    ]
    return markdown.page("Print rules", _INTRO, table(("rule", "requires"), rows), *groups)


def section(name: str, text: dict[str, str], record: dict[str, Any]) -> str:
    """The section of a rule: what it requires, pictures, the finding, and the limits of each printer."""
    parts = [f"### {name}", plain(text["requires"]), f"If it is broken: {plain(text['otherwise'])}"]
    parts.append(" ".join(_picture(name, side, record[side]["case"]) for side in ("good", "bad")))
    rows = [_row(finding) for finding in record["bad"]["findings"]]
    parts.append(table(("finding", "measured", "limit", "remedy", "source of the limit"), rows))
    if name in _LIMITS:
        parts.append(limits(_LIMITS[name]))
    return "\n\n".join(parts)


def anchor(name: str) -> str:
    """The anchor of a rule on the page."""
    return name.replace(" ", "-")


def limits(limit: str) -> str:
    """What each printer states of a limit."""
    rows = []
    for name, printer in printers().items():
        for kind, size in _sizes(printer, limit):
            least = "" if size.least is None else f"{size.least:g}"
            rows.append((f"[{name}](printers.md#{name})", kind, least, f"{size.recommended:g}", plain(size.source)))
    head = ("printer", "material", "error below, mm", "warning below, mm", "source")
    return table(head, rows)


def _sizes(printer: Printer, limit: str) -> list[tuple[str, FeatureSize]]:
    """The sizes of a limit by kind of material, where it depends on it."""
    keys = {"": f"{limit}_mm", "rigid": f"{limit}_rigid_mm", "soft": f"{limit}_soft_mm"}
    sizes = {kind: getattr(printer.smallest, key, None) for kind, key in keys.items()}
    return [(kind, size) for kind, size in sizes.items() if size is not None]


def _picture(name: str, side: str, label: str) -> str:
    file = f"{anchor(name)}-{side}.svg"
    if not (PICTURES / file).is_file():
        raise FileNotFoundError(f"{file}: run make rule-pictures")
    return f"![{side}: {plain(label)}](../rules/{file})"


def _row(finding: dict[str, Any]) -> tuple[str, ...]:
    excess = finding["excess"] or {}
    unit = f" {excess['unit']}" if excess.get("unit") else ""
    measured, limit = (f"{excess[key]:g}{unit}" if key in excess else "" for key in ("measured", "limit"))
    text = f"*{finding['severity']}* on {code(finding['body'])}: {plain(finding['message'])}"
    return text, measured, limit, plain(finding["fix"]), plain(finding["source"])
