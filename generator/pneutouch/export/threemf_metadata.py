"""Metadata of a 3MF model or object: well-known names, and our own in a declared namespace.

lib3mf 2.5 cannot read a model back whose XML has a text of 65536 bytes or more, nor one in which an escape such as
``&quot;`` lies across a multiple of 65536 bytes (both measured; tests/export/test_threemf_read.py). Our own values are
therefore percent-encoded where XML would escape, continued in further entries where they are long, and the longest
stand last.
"""

from typing import Any
from urllib.parse import unquote

NAMESPACE = "https://pneutouch.org/3mf/2026"

WELL_KNOWN = frozenset({"Title", "Designer", "Description", "Copyright", "LicenseTerms", "Application"})
"""Names of metadata that the specification defines; they have no namespace."""

_LONGEST = 60_000
"""Bytes of one entry."""

_ENCODED = str.maketrans({letter: f"%{ord(letter):02X}" for letter in "%&<>\"'"})


def add_metadata(owner: Any, metadata: dict[str, str]) -> None:
    """Add entries to a model or an object; a text too long for one is continued in ``key-2``, ``key-3`` ..."""
    group = owner.GetMetaDataGroup()
    for key in sorted(metadata, key=lambda key: (len(metadata[key]), key)):
        if key in WELL_KNOWN:
            group.AddMetaData("", key, metadata[key], "xs:string", True)
            continue
        text = metadata[key].translate(_ENCODED)
        step = _LONGEST if text.isascii() else _LONGEST // 4
        for k in range(0, max(len(text), 1), step):
            name = f"{key}-{k // step + 1}" if k else key
            group.AddMetaData(NAMESPACE, name, text[k : k + step], "xs:string", True)


def metadata_of(owner: Any) -> dict[tuple[str, str], str]:
    """Values by namespace and name of a model or an object; ours decoded, and continued ones joined."""
    group = owner.GetMetaDataGroup()
    entries = [group.GetMetaData(k) for k in range(group.GetMetaDataCount())]
    values = {(entry.GetNameSpace(), entry.GetName()): entry.GetValue() for entry in entries}
    local = {name: value for (space, name), value in values.items() if space == NAMESPACE}
    foreign = {key: value for key, value in values.items() if key[0] != NAMESPACE}
    for name in list(local):
        k = 2
        while name in local and f"{name}-{k}" in local:
            local[name] += local.pop(f"{name}-{k}")
            k += 1
    return {**foreign, **{(NAMESPACE, name): unquote(value) for name, value in local.items()}}
