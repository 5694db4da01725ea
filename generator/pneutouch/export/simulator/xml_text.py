"""Elements of XML with numbers in a fixed form."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any
from xml.etree import ElementTree

_DIGITS = 9

_NOTHING = 1e-15
"""Coordinates and moments below this (m, kg m2) are rounding."""


def add(parent: ElementTree.Element, tag: str, **attributes: str | float) -> ElementTree.Element:
    """Add an element with attributes, numbers as text."""
    texts = {key: value if isinstance(value, str) else number_text(value) for key, value in attributes.items()}
    return ElementTree.SubElement(parent, tag, texts)


def number_text(value: float) -> str:
    """A number with nine digits."""
    return f"{float(value):.{_DIGITS}g}"


def vector(values: Iterable[Any]) -> str:
    """Numbers with spaces between."""
    return " ".join(number_text(value if abs(value) > _NOTHING else 0.0) for value in values)


def xml_document(root: ElementTree.Element) -> bytes:
    """A document, indented."""
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"
