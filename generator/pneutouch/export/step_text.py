"""Put the text of a STEP file into one canonical form.

Open CASCADE writes the time into the header, numbers occurrences by a counter that runs on through the
process, and orders styles by memory address. Nothing of that is content, so it is taken out: entities are
renumbered by walking the file from its roots, the roots are sorted by a hash of all they refer to, and
numbers are rounded above the noise of floating-point sums.
"""

import hashlib
import itertools
import re
from functools import cache

_TIMESTAMP = re.compile(r"(FILE_NAME\('[^']*',)'[^']*'")
_ENTITY = re.compile(r"#(\d+)\s*=\s*(.*?);\s*(?=#\d+\s*=|ENDSEC)", re.DOTALL)
_REFERENCE = re.compile(r"#(\d+)")
_REAL = re.compile(r"(?<![#\w.])-?\d+\.\d*(?:E[+-]?\d+)?")
_DECIMALS = 10
"""Decimals of lengths: 1e-10 mm. Open CASCADE's own tolerance is 1e-7, and smaller digits are noise of the run."""

_OCCURRENCE = re.compile(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'")


def canonical(text: str) -> str:
    """Return the same STEP content with the header's time fixed and the entities in canonical order."""
    head, data, rest = text.partition("DATA;")
    body, end, tail = rest.partition("ENDSEC;")
    entities = {int(number): _tidy(content) for number, content in _ENTITY.findall(body + end)}
    order = _walk(entities)
    number = {old: new for new, old in enumerate(order, start=1)}

    def renamed(content: str) -> str:
        return _REFERENCE.sub(lambda match: f"#{number[int(match[1])]}", content)

    lines = [f"#{number[old]} = {renamed(entities[old])};" for old in order]
    header = _TIMESTAMP.sub(r"\1'1970-01-01T00:00:00'", head, count=1)
    return f"{header}{data}\n" + "\n".join(lines) + f"\n{end}{tail}"


def _tidy(content: str) -> str:
    """One line without the blanks and breaks whose places depend on how long the numbers are."""
    joined = "".join(line.strip() for line in content.splitlines())
    texts = joined.split("'")
    outside = [_REAL.sub(_rounded, "".join(text.split())) for text in texts[::2]]
    pieces = [piece for pair in itertools.zip_longest(outside, texts[1::2]) for piece in pair if piece is not None]
    return _OCCURRENCE.sub(r"\1'1'", "'".join(pieces))


def _rounded(match: re.Match[str]) -> str:
    return f"{round(float(match[0]), _DECIMALS) + 0.0:.{_DECIMALS}f}".rstrip("0")


def _walk(entities: dict[int, str]) -> list[int]:
    """Entities in depth-first order from the roots, referenced ones first."""
    references = {old: [int(n) for n in _REFERENCE.findall(text)] for old, text in entities.items()}

    @cache
    def digest(old: int) -> str:
        content = _REFERENCE.sub(lambda match: digest(int(match[1])), entities[old])
        return hashlib.sha256(content.encode()).hexdigest()

    referred = {n for numbers in references.values() for n in numbers}
    order: dict[int, None] = {}

    def visit(old: int) -> None:
        if old not in order:
            for other in references[old]:
                visit(other)
            order[old] = None

    for root in sorted((old for old in entities if old not in referred), key=digest):
        visit(root)
    return list(order)
