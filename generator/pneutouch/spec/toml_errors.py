"""Explanation of an error in a TOML file, in plain words, with the line and a caret under the place."""

import re
import tomllib

_PLAIN = {
    "Invalid value": "this is no value; text stands in double quotes, and true and false are in small letters",
    "Invalid statement": "this is neither a key nor a table; write key = value, or [table]",
    "Expected '=' after a key in a key/value pair": "a key is followed by = and a value",
    "Expected newline or end of document after a statement": "only one key = value stands on a line",
    "Expected ']' at the end of a table declaration": "the name of a table ends with ]",
    "Expected ']]' at the end of an array declaration": "the name of a list of tables ends with ]]",
    "Invalid initial character for a key part": "a key has letters, digits, - and _, or stands in double quotes",
    "Unclosed array": "a list ends with ], its values with commas between",
    "Unclosed inline table": "a table on one line ends with }, its keys with commas between",
    "Unterminated string": "text ends with the quote that it begins with, on the same line",
    "Unescaped '\\' in a string": "a backslash in text is written twice",
    "Invalid hex value": "a code after \\u has four hexadecimal digits, after \\U eight",
    "Escaped character is not a Unicode scalar value": "this code is no character",
    "Invalid date or datetime": "there is no such date",
    "Cannot overwrite a value": "this key or table is there twice",
}
_BEGINNINGS = {
    "Cannot declare": "this table is there twice",
    "Cannot redefine namespace": "this table is there twice",
    "Cannot mutate immutable namespace": "this key is there twice",
    "Duplicate inline table key": "this key is there twice",
    "Found invalid character": "this character cannot stand in a file of text",
    "Illegal character": "text is on one line, without control characters",
    "Expected": "a character is missing",
}
_PLACE = re.compile(
    r"^(?P<problem>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)$", re.DOTALL
)
_WIDEST = 100


def toml_problem(text: str, error: tomllib.TOMLDecodeError) -> str:
    """The problem with its line, the line itself, and a caret under the column where reading stopped."""
    place = _PLACE.match(str(error))
    if place is None:
        return f"not valid TOML: {error}"
    problem, lines = _plain(place["problem"]), text.splitlines() or [""]
    number = int(place["line"]) if place["line"] else len(lines)
    line = lines[min(number, len(lines)) - 1]
    column = int(place["column"]) - 1 if place["column"] else len(line)
    first = max(0, column - _WIDEST + 1)
    shown = "".join(c if c.isprintable() else " " for c in line[first : first + _WIDEST])
    return f"line {number}, column {column + 1}: {problem}\n  {shown}\n  {' ' * (column - first)}^"


def _plain(problem: str) -> str:
    """The parser's words as a user of the file would put them."""
    if problem in _PLAIN:
        return _PLAIN[problem]
    return next((plain for start, plain in _BEGINNINGS.items() if problem.startswith(start)), problem)
