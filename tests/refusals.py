"""Errors in the fields that are their contract: what was given wrongly, and where; never in their words."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from pneutouch.errors import InputError


@contextmanager
def refused(
    key: str | None, value: Any = None, *, file: object = None, remedy: str = "", fields: Collection[str] = ()
) -> Iterator[None]:
    """An input is refused at a key; where they are given also with its value, file, a word of its remedy, and fields."""
    with pytest.raises(InputError) as caught:
        yield
    assert caught.value.key == key, caught.value
    assert value is None or caught.value.value == value, caught.value
    assert file is None or caught.value.file == str(file), caught.value
    assert remedy in (caught.value.remedy or ""), caught.value
    assert set(fields) <= set(caught.value.fields), caught.value
