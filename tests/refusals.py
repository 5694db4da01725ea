"""Errors in the fields that are their contract: what was given wrongly, and where; never in their words."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from pneutouch.errors import InputError


@contextmanager
def refused(key: str, value: Any = None) -> Iterator[None]:
    """An input is refused at a key, and where one is given with its value."""
    with pytest.raises(InputError) as caught:
        yield
    assert caught.value.key == key, caught.value
    assert value is None or caught.value.value == value, caught.value
