"""Numbers in texts."""

from __future__ import annotations

import pytest

from pneutouch.spec.number import plain_number, plain_numbers


@pytest.mark.parametrize(("text", "value"), [("10", 10), (" -1.5 ", -1.5), ("+.5", 0.5), ("1e-3", 1e-3), ("2.", 2)])
def test_a_number(text, value):
    assert plain_number(text) == value


@pytest.mark.parametrize("text", ["1_0", "nan", "inf", "1e999", "٣", "½", "0x10", "", " ", "1,5", "1 0", "1e", "ten"])
def test_no_number(text):
    with pytest.raises(ValueError, match="is no finite number"):
        plain_number(text)


def test_numbers_with_commas():
    assert plain_numbers("0, 22,1e1") == [0, 22, 10]
    with pytest.raises(ValueError, match="1_0"):
        plain_numbers("0,1_0")
