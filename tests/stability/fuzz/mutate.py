"""Damage to texts, bytes and words, drawn from a random generator with a seed."""

from __future__ import annotations

import json
import random
import re

WORDS = (
    *("", " ", "-", "--", "-1", "0", "1", "1e400", "-1e-320", "nan", "inf", "1_0", "٣", "½", "9" * 400, "9" * 5000),
    *(
        "x" * 300,
        "x" * 5000,
        "../../x",
        "..",
        ".",
        "/",
        "/dev/zero",
        "~",
        "a\nb",
        "a\tb",
        "\x1b[31mred",
        "\u202etxt",
        "\udc80",
    ),
    *(
        "=1+1",
        "@x",
        "a,b",
        ",",
        "1:2:3",
        "1:2:999999999",
        "2:1:-1",
        "'",
        '"',
        "[",
        "[1",
        "{",
        "{}",
        "[[[]]]",
        "true",
        "%",
        "%s",
    ),
    *("paper-dome", "graded-dome", "texture-specimen", "TangoPlus", "VeroClear", "objet260-connex", "2026-11-21", "5%"),
    *(
        "membrane.material=FLX9940",
        "membrane.inner_radius_mm=1e9",
        "pneumatics.driving_pressures_kPa=[]",
        "a.b=c",
        "a=b",
        ".",
    ),
)
"""Words that are right in one place and wrong in most."""

NUMBERS = (
    *(
        "0",
        "-0.0",
        "-1",
        "1",
        "2",
        "3.5",
        "1e308",
        "-1e308",
        "1e-320",
        "nan",
        "inf",
        "-inf",
        "9" * 30,
        "9" * 400,
        "9" * 4301,
    ),
    *(
        "true",
        '"x"',
        '""',
        "[]",
        "{}",
        "[1, 2]",
        "[[1]]",
        "[" * 300,
        "1979-05-27",
        "12:00:00",
        "0x10",
        "1_000",
        "{a = 1}",
    ),
)
LINES = (
    "[x]",
    "[[runs]]",
    "[membrane]",
    "x = 1",
    '"a.b" = [1]',
    "= 1",
    "x =",
    "[membrane.material]",
    "\x00",
    "\ufeff",
    "# \x1b[31m",
    "a.b.c.d = 1",
)
CELLS = (
    "",
    "nan",
    "inf",
    "-1e400",
    "1e400",
    "abc",
    "=1+1",
    '"',
    "1,5",
    "1;5",
    "\t",
    " 12 ",
    "1_0",
    "9" * 400,
    "−1",
    "0x1",
    "1e5",
)

_NUMBER = re.compile(r"(?<![\w.\"])[-+]?\d[\d.eE+-]*")
_STRING = re.compile(r'"[^"\n]*"')
_KEY = re.compile(r"^(\s*)([\w-]+)(\s*=)", re.MULTILINE)


def damaged_toml(text: str, rng: random.Random) -> bytes:
    """A TOML file with one to three faults; now and then with faults in its bytes."""
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        text = rng.choice((_number, _number, _number, _string, _string, _key, _line, _line, _cut))(text, rng)
    content = text.encode("utf-8", "surrogatepass")
    return damaged_bytes(content, rng) if rng.random() < 0.1 else content


def damaged_csv(text: str, rng: random.Random) -> bytes:
    """A table with faults in its cells, lines or bytes."""
    lines = text.split("\n")
    for _ in range(rng.choice((1, 1, 2, 5))):
        at = rng.choice((0, 0, rng.randrange(len(lines))))
        cells = lines[at].split(",")
        place = rng.randrange(len(cells))
        match rng.randrange(6):
            case 0:
                cells[place] = rng.choice(CELLS)
            case 1:
                cells[place] = rng.choice(WORDS).replace("\n", " ")
            case 2:
                del cells[place]
            case 3:
                cells.insert(place, cells[place])
            case 4:
                lines.insert(at, rng.choice(("", "#", "Time (s)\tLoad [N]", "\x00", "x" * 3000, lines[at])))
                continue
            case 5:
                cells = ";".join(cells).replace(".", ",").split("\x00")
        lines[at] = ",".join(cells)
    content = "\n".join(lines).encode("utf-8", "surrogatepass")
    return damaged_bytes(content, rng) if rng.random() < 0.2 else content


def damaged_bytes(content: bytes, rng: random.Random) -> bytes:
    """Bytes changed, cut off, doubled or put in."""
    changed = bytearray(content)
    for _ in range(rng.choice((1, 1, 3, 20))):
        at = rng.randrange(len(changed) + 1)
        match rng.randrange(5):
            case 0 if at < len(changed):
                changed[at] = rng.randrange(256)
            case 1:
                del changed[at:]
            case 2:
                del changed[at : at + rng.choice((1, 4, 100))]
            case 3:
                changed[at:at] = rng.choice((b"\0", b"\xff\xfe", b"9" * 50, b"<a>", b"\n", b'"', rng.randbytes(8)))
            case _:
                changed[at:at] = changed[at : at + rng.choice((1, 16, 300))]
    return bytes(changed)


def damaged_words(words: list[str], options: list[str], rng: random.Random) -> list[str]:
    """A command line with one to three faults; ``options`` are those that its command has."""
    words = list(words)
    for _ in range(rng.choice((1, 1, 2, 3))):
        at = rng.randrange(1, len(words) + 1)
        match rng.randrange(8):
            case 0 if at < len(words):
                del words[at]
            case 1 if at < len(words):
                words[at] = rng.choice(WORDS)
            case 2:
                words.insert(at, rng.choice(WORDS))
            case 3 if at < len(words):
                other = rng.randrange(1, len(words))
                words[at], words[other] = words[other], words[at]
            case 4 if at < len(words):
                words[at] = damaged_bytes(words[at].encode("utf-8", "surrogatepass"), rng).decode("utf-8", "replace")
                words[at] = words[at].replace("\0", "")
            case _ if options:
                words[at:at] = [rng.choice(options), *([rng.choice(WORDS)] if rng.random() < 0.8 else [])]
    return words


def _number(text: str, rng: random.Random) -> str:
    return _replaced(_NUMBER, text, rng.choice(NUMBERS), rng)


def _string(text: str, rng: random.Random) -> str:
    word = rng.choice(WORDS).encode("utf-8", "replace").decode()
    return _replaced(_STRING, text, rng.choice((json.dumps(word, ensure_ascii=False), rng.choice(NUMBERS))), rng)


def _key(text: str, rng: random.Random) -> str:
    matches = list(_KEY.finditer(text))
    if not matches:
        return text
    one, other = rng.choice(matches), rng.choice(matches)
    return text[: one.start(2)] + rng.choice((other[2], f"{one[2]}x", '"a b"')) + text[one.end(2) :]


def _line(text: str, rng: random.Random) -> str:
    lines = text.split("\n")
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(4):
        case 0:
            del lines[at]
        case 1:
            lines.insert(at, lines[other])
        case 2:
            lines[at], lines[other] = lines[other], lines[at]
        case _:
            lines.insert(at, rng.choice(LINES))
    return "\n".join(lines)


def _cut(text: str, rng: random.Random) -> str:
    return text[: rng.randrange(len(text) + 1)]


def _replaced(pattern: re.Pattern[str], text: str, word: str, rng: random.Random) -> str:
    matches = list(pattern.finditer(text))
    if not matches:
        return text
    match = rng.choice(matches)
    return text[: match.start()] + word + text[match.end() :]
