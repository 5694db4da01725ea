"""Data as TOML text: plain values first, then tables, then arrays of tables; and commented design files."""

import datetime
import json
import re
import textwrap
from collections.abc import Mapping
from typing import Any

from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Declaration, Table, declarations, table_of
from pneutouch.spec.read import Changes, bare_value

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(content: Mapping[str, Any]) -> str:
    """TOML of nested tables, lists, text, numbers, booleans and dates; None is left out."""
    return "\n\n".join(_blocks(content, ())) + "\n"


def value_text(value: Any) -> str:
    """One value on one line, without entries of None in a table. Raises TypeError for a value that TOML cannot hold."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # JSON escapes what TOML requires to be escaped, except the delete character.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    if isinstance(value, Mapping):
        entries = (f"{key_text(key)} = {value_text(item)}" for key, item in value.items() if item is not None)
        return "{ " + ", ".join(entries) + " }"
    if isinstance(value, datetime.date):
        return value.isoformat()
    if isinstance(value, int | float):
        return repr(value)
    raise TypeError(f"{value!r} has no form in TOML")


def key_text(key: str) -> str:
    """A key, quoted where it must be."""
    return key if _BARE.fullmatch(key) else json.dumps(key, ensure_ascii=False)


def _blocks(content: Mapping[str, Any], path: tuple[str, ...], head: str = "") -> list[str]:
    tables = {key: value for key, value in content.items() if isinstance(value, Mapping)}
    lists = {key: value for key, value in content.items() if isinstance(value, list) and value}
    arrays = {key: value for key, value in lists.items() if all(isinstance(item, Mapping) for item in value)}
    lines = [
        f"{key_text(key)} = {value_text(value)}"
        for key, value in content.items()
        if value is not None and key not in tables and key not in arrays
    ]
    blocks = ["\n".join([head, *lines] if head else lines)] if lines or (head and not tables) else []
    for key, value in tables.items():
        blocks += _blocks(value, (*path, key), f"[{_dotted((*path, key))}]")
    for key, rows in arrays.items():
        for row in rows:
            blocks += _blocks(row, (*path, key), f"[[{_dotted((*path, key))}]]")
    return blocks


def _dotted(path: tuple[str, ...]) -> str:
    return ".".join(key_text(key) for key in path)


def flat(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a file by ``table.key``, after those outside its tables by their key."""
    plain = {key: value for key, value in tables.items() if not isinstance(value, Mapping)}
    inner = {name: table for name, table in tables.items() if name not in plain}
    return plain | {f"{name}.{key}": value for name, table in inner.items() for key, value in table.items()}


def assignments(changes: Changes) -> list[str]:
    """Changes as texts ``key=value`` for `parse_changes`, a text value unquoted where it reads back unchanged."""
    bare = {v for v in changes.values() if isinstance(v, str) and v == v.strip() and bare_value(v) == v}
    return [f"{key}={v if isinstance(v, str) and v in bare else value_text(v)}" for key, v in changes.items()]


def design_template(
    title: str, values: Mapping[str, Any] | None = None, note: str | None = None, model: type[Table] = DesignFile
) -> str:
    """Commented design file: every key of its tables with default, unit, bounds and help. ``values`` replace defaults
    by table and key; [mould], [cast_ring], [accepted] and keys without a table are written only if they are in
    ``values``. ``note`` replaces the second sentence of the first line. ``model``: of another file of such tables."""
    chosen = values or {}
    kind = "design" if model is DesignFile else "pad"
    blocks = [f"# {title}: a pneutouch {kind}. {note or 'Every key may be left out. The values are the defaults.'}"]
    blocks += [f"{key} = {value_text(value)}" for key, value in chosen.items() if not isinstance(value, Mapping)]
    for key in model.model_fields:
        table = table_of(model, key)
        # Mould and ring are for cast membranes, and nothing is accepted at first: no clutter in a design without them.
        if table is None or (key in ("mould", "cast_ring", "accepted") and key not in chosen):
            continue
        lines = [f"[{key}]"]
        for entry in declarations(table):
            default = title if (key, entry.key) == ("document", "title") else entry.default
            default = chosen.get(key, {}).get(entry.key, default)
            lines += _entry(entry, default)
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks) + "\n"


def _entry(entry: Declaration, default: Any) -> list[str]:
    bounds = "" if entry.low is None else f" From {entry.low:g} to {entry.high:g} {entry.unit}".rstrip() + "."
    names = f" One of the {entry.registry}: see pneutouch list." if entry.registry else ""
    names += f" One of: {', '.join(entry.one_of.names())}." if entry.one_of else ""
    comment = textwrap.wrap(f"{entry.help}{bounds}{names}", width=96)
    value = f"# {entry.key} =" if default in (None, []) else f"{entry.key} = {value_text(default)}"
    if entry.one_of and default == entry.default:
        # As in a dump, where the usual one is left out.
        value = f"# {value}"
    return [*(f"# {line}" for line in comment), value]
