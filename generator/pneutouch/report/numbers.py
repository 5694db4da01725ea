"""Numbers as sheets print them, and the relation of two intervals."""

import math

DASH = "–"
MINUS = "\N{MINUS SIGN}"
_PLAIN = 1e-5, 1e6
"""Magnitudes between these are written without an exponent."""

Bounds = tuple[float, float | None, float | None]
"""Value, lower and upper end of its interval; None for an end that is not known."""


def decimals(value: float, digits: int) -> int:
    """Number of decimals, at least 0, that show a value with ``digits`` significant digits."""
    return max(digits - 1 - math.floor(math.log10(abs(value))), 0) if value else digits - 1


def number(value: float | None, digits: int = 3, like: float | None = None) -> str:
    """A value with ``digits`` significant digits, or the decimals that ``like`` would have; a dash if not known."""
    if value is None or not math.isfinite(value):
        return DASH
    scale = value if like is None else like
    if scale and not _PLAIN[0] <= abs(scale) < _PLAIN[1]:
        return f"{value:.{digits - 1}e}".replace("-", MINUS)
    text = f"{value:.{decimals(scale, digits)}f}"
    return text.replace("-", MINUS) if float(text) else text.lstrip("-")


def between(bounds: Bounds, digits: int = 3) -> str:
    """An interval with the decimals of its value, such as ``2.31 to 2.42``; a dash if an end is not known."""
    value, low, high = bounds
    if low is None or high is None:
        return DASH
    return f"{number(low, digits, value)} to {number(high, digits, value)}"


def signed(value: float | None, digits: int = 1) -> str:
    """A difference with its sign and ``digits`` decimals; a dash for None or a number that is not finite."""
    if value is None or not math.isfinite(value):
        return DASH
    text = f"{value:+.{digits}f}"
    return text.replace("-", MINUS) if float(text) else text[1:]


def difference(measured: float, predicted: float) -> float | None:
    """Measured less predicted in percent of the magnitude of the predicted; None if the predicted is zero."""
    return 100 * (measured - predicted) / abs(predicted) if predicted else None


def overlap(measured: Bounds, predicted: Bounds) -> bool | None:
    """True if a measured interval (else the value) and a predicted band share a value; None without a band."""
    value, low, high = measured
    _, least, most = predicted
    if least is None or most is None:
        return None
    return (value if low is None else low) <= most and least <= (value if high is None else high)


def word_of(yes: bool | None, words: tuple[str, str, str] = ("yes", "no", DASH)) -> str:
    """The first word for True, the second for False, the third for None (not known)."""
    return words[2] if yes is None else words[0] if yes else words[1]
