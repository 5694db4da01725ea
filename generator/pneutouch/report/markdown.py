"""Markdown sheets from templates, for those who print and those who measure."""

from collections.abc import Iterable
from typing import Any

from pneutouch.report.pages import TEMPLATES


def filled(template: str, **values: Any) -> str:
    """A template with its values: filters write numbers, times and lists, and keep text from being read as Markdown."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,
    )
    environment.filters |= {"f": format, "md": _escaped, "listed": _listed, "time": _time, "value": _value}
    return environment.get_template(template).render(**values).rstrip() + "\n"


def _escaped(text: str) -> str:
    """Text that Markdown takes for no table, HTML or escape."""
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")


def _value(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"


def _listed(values: Iterable[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
