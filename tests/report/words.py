"""All texts of a sheet, in its order: what the tests of sheets look for."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

import pypdfium2

from pneutouch.report.blocks import (
    Cell,
    Columns,
    FramedBlocks,
    Heading,
    Items,
    Plot,
    Plots,
    Sheet,
    SheetTable,
    Text,
    Tiles,
    View,
)


def texts_of(blocks) -> Iterator[str]:
    """Every text of blocks, cells one by one."""
    for block in blocks:
        match block:
            case Items():
                yield from block.lines
            case SheetTable():
                for cells in (block.head, *block.rows):
                    for cell in cells:
                        yield from (cell.text, cell.note) if isinstance(cell, Cell) else (cell,)
            case Plots():
                yield from texts_of(block.plots)
                yield block.caption
            case Plot():
                yield from (block.title, block.caption)
            case Tiles():
                for tile in block.tiles:
                    yield from (tile.name, tile.value, tile.unit, tile.condition)
            case Columns():
                for column in block.columns:
                    yield from texts_of(column)
            case FramedBlocks():
                yield block.title
                yield from texts_of(block.blocks)
            case View():
                yield block.caption
            case Heading() | Text():
                yield block.text


def sheet_texts(sheet: Sheet) -> list[str]:
    """Every text of a sheet that is not empty."""
    head = [sheet.title, sheet.subtitle, sheet.mark, sheet.mark_note, *(text for pair in sheet.facts for text in pair)]
    return [text for text in (*head, *texts_of(sheet.blocks)) if text]


def page_words(page: bytes) -> str:
    """The words of a page without its figures and style."""
    bare = re.sub(r"<style>.*?</style>|<svg.*?</svg>|<[^>]+>", " ", page.decode(), flags=re.DOTALL)
    return " ".join(html.unescape(bare).split())


def pdf_words(pdf: bytes) -> str:
    """The PDF's words with single blanks: lines break anywhere, and pdfium marks a hyphen at a line's end."""
    pages = "\n".join(page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(pdf))
    return " ".join(re.sub(r"[-\x02\ufffe]\s*\n", "-", pages).replace("\x02", "-").replace("\ufffe", "-").split())
