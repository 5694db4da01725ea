"""Broken TOML is explained in plain words, with the line and a caret under the place."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.read import read_toml

CASES = [
    ("a = 1\nwall_mm 1.0\n", "line 2, column 9: a key is followed by = and a value", "wall_mm 1.0", 8),
    ("a = tru", "line 1, column 5: this is no value;", "a = tru", 4),
    ('a = "abc', "line 1, column 9: text ends with the quote", 'a = "abc', 8),
    ("a = [1, 2", "line 1, column 10: a list ends with ]", "a = [1, 2", 9),
    ("[a\nb = 1", "line 1, column 3: the name of a table ends with ]", "[a", 2),
    ("a = 1\na = 2", "line 2, column 6: this key or table is there twice", "a = 2", 5),
    ("[t]\n[t]", "line 2, column 3: this table is there twice", "[t]", 2),
    ("a = 1 b = 2", "line 1, column 7: only one key = value stands on a line", "a = 1 b = 2", 6),
]


@pytest.mark.parametrize(("text", "problem", "line", "column"), CASES)
def test_broken_toml_is_explained_where_it_breaks(tmp_path, text, problem, line, column):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        read_toml(tmp_path / "a.toml")
    first, shown, caret = str(caught.value).splitlines()
    assert first.startswith(f"{tmp_path / 'a.toml'}: {problem}")
    assert shown == f"  {line}"
    assert caret == f"  {' ' * column}^"


def test_a_line_of_any_length_and_content_is_shown_around_the_place(tmp_path):
    (tmp_path / "a.toml").write_text(f'a = "{"x" * 5000}" \x1b[31m')
    with pytest.raises(InputError) as caught:
        read_toml(tmp_path / "a.toml")
    _, shown, caret = str(caught.value).splitlines()
    assert "\x1b" not in shown and len(shown) <= 102
    assert len(caret) <= 102
