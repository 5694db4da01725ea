"""Words of a command line: numbers are plain digits, and what is echoed moves no cursor and has an end."""

from __future__ import annotations

import pytest

from pneutouch.cli.select import SELECT_FIELDS
from pneutouch.errors import InputError


@pytest.mark.parametrize(
    ("words", "flag"),
    [
        (["select", "--sensitivity", "1_0"], "--sensitivity 1_0"),
        (["select", "--sensitivity", "2", "--pick", "1_0"], "--pick 1_0"),
        (["select", "--sensitivity", "nan"], "--sensitivity nan"),
        (["plan", "paper-dome", "--specimens", "1_0"], "--specimens 1_0"),
        (["predict", "paper-dome", "--monte-carlo", "1_000"], "--monte-carlo 1_000"),
        (["predict", "paper-dome", "--model", "auto", "--tolerance", "1_0%"], "--tolerance 1_0%"),
        (["simulate", "paper-dome", "--pressures", "0,1_0"], "--pressures 0,1_0"),
        (["scan", "texture-specimen", "--design", "paper-dome", "--pressures", "0,1_0"], "--pressures 0,1_0"),
        (["select", "--sensitivity", "2", "--same-at", "0,1_0"], "--same-at 0,1_0"),
        (["predict", "paper-dome", "--set", "membrane.inner_radius_mm=1_0"], "--set membrane.inner_radius_mm=1_0"),
        (["predict", "paper-dome", "--set", "membrane.inner_radius_mm=0x10"], "--set membrane.inner_radius_mm=0x10"),
        (
            ["predict", "paper-dome", "--set", "pneumatics.driving_pressures_kPa=0,1_0"],
            "--set pneumatics.driving_pressures_kPa=0,1_0",
        ),
        (
            ["predict", "paper-dome", "--set", "pneumatics.driving_pressures_kPa=[0, 1_0.5]"],
            "--set pneumatics.driving_pressures_kPa=[0, 1_0.5]",
        ),
        (["sweep", "--design", "paper-dome", "--over", "membrane.inner_radius_mm=8,1_0"], 'inner_radius_mm = "1_0"'),
        (["sweep", "--design", "paper-dome", "--over", "membrane.inner_radius_mm=8:1_0:3"], "8 to 1_0"),
    ],
)
def test_a_number_with_an_underscore_is_none(words, flag, command, tmp_path):
    done = command(*words)
    assert done.returncode == 2, done.stderr
    assert flag in done.stderr, done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize(
    "words", [["{}"], ["--{}"], ["list", "{}"], ["list", "--{}"], ["list", "a", "{}"], ["predict", "{}"], ["new", "{}"]]
)
@pytest.mark.parametrize("word", ["\x1b[31mred", "a\rb", "\u202etxt", "\x9b31m", "y" * 5000, "\udc80"])
def test_what_is_echoed_is_escaped_and_cut(words, word, command):
    done = command(*[one.format(word) for one in words])
    assert done.returncode == 2
    assert all(c.isprintable() or c == "\n" for c in done.stderr), ascii(done.stderr)
    assert len(done.stderr) < 1500 and "y" * 401 not in done.stderr


@pytest.mark.parametrize(
    ("text", "percent", "note"),
    [
        ("5", 5.0, ""),
        ("5%", 5.0, ""),
        ("5 %", 5.0, ""),
        ("7", 7.0, ""),
        ("0.5%", 0.5, ""),
        ("0.5", 50.0, "note: --same-within 0.5 is taken as a share, 50 %; 0.5 per cent is --same-within 0.5%\n"),
        ("0.05", 5.0, "note: --same-within 0.05 is taken as a share, 5 %; 0.05 per cent is --same-within 0.05%\n"),
    ],
)
def test_per_cent_is_read_with_and_without_its_sign_and_below_1_as_a_share(text, percent, note, capsys):
    assert SELECT_FIELDS["same_within"].parse(text) == percent
    assert capsys.readouterr().err == note


@pytest.mark.parametrize("text", ["0", "-2", "101", "much", "%", "5%%", ""])
def test_what_is_no_per_cent_is_refused(text):
    with pytest.raises(InputError, match="a positive share of at most 100 %") as found:
        SELECT_FIELDS["tolerance"].parse(text)
    assert (found.value.key, found.value.value) == ("tolerance", text)


def test_a_numerical_error_is_read_in_per_cent_and_below_1_as_a_share(command):
    words = ["predict", "paper-dome", "--set", "indentation.depth_mm=4.5", "--json", "--tolerance"]
    signed, plain = command(*words, "2%"), command(*words, "2")
    assert (signed.returncode, plain.returncode) == (0, 0), plain.stderr
    assert signed.stdout == plain.stdout
    assert "note: --tolerance" not in signed.stderr + plain.stderr
    share = command(*words, "0.02")
    assert (share.returncode, share.stdout) == (0, signed.stdout)
    assert "note: --tolerance 0.02 is taken as a share, 2 %" in share.stderr
