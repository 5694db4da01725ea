"""A commented design file, written from the declarations."""

import textwrap
from collections.abc import Mapping
from typing import Any

from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Declaration, declarations, table_of
from pneutouch.spec.toml_text import value_text


def design_template(title: str, values: Mapping[str, Any] | None = None, note: str | None = None) -> str:
    """Return a design file with every table and key, its default, unit, bounds and help.

    ``values`` by table and key stand in place of defaults; ``note`` in place of the head's second sentence.
    """
    chosen = values or {}
    blocks = [f"# {title}: a pneutouch design. {note or 'Every key may be left out; shown are the defaults.'}"]
    blocks += [f"{key} = {value_text(value)}" for key, value in chosen.items() if not isinstance(value, Mapping)]
    for key in DesignFile.model_fields:
        model = table_of(DesignFile, key)
        # Mould and ring are for cast membranes: a design that names none is not cluttered by them.
        if model is None or (key in ("mould", "cast_ring") and key not in chosen):
            continue
        lines = [f"[{key}]"]
        for entry in declarations(model):
            default = title if (key, entry.key) == ("document", "title") else entry.default
            default = chosen.get(key, {}).get(entry.key, default)
            lines += _entry(entry, default)
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks) + "\n"


def _entry(entry: Declaration, default: Any) -> list[str]:
    bounds = "" if entry.low is None else f" From {entry.low:g} to {entry.high:g} {entry.unit}".rstrip() + "."
    names = f" One of the {entry.registry}: see pneutouch list." if entry.registry else ""
    comment = textwrap.wrap(f"{entry.help}{bounds}{names}", width=96)
    value = f"# {entry.key} =" if default is None else f"{entry.key} = {value_text(default)}"
    return [*(f"# {line}" for line in comment), value]
