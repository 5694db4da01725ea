"""What names of columns tell, and that what they leave open is asked and not guessed."""

from __future__ import annotations

import pytest

from pneutouch.bench.reading import PLATE
from pneutouch.bench.source import identify, meaning_of
from pneutouch.bench.tensile.read import _facts
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap
from pneutouch.spec.values import plain_number
from pneutouch.tables.layout import score
from pneutouch.tables.read import whole
from pneutouch.tables.unit_words import UNITS, unit_of

ANY = ColumnMap()
NUMBERS = "0.0,1.5,0.25,10.5\n0.1,1.6,0.35,10.6\n0.2,1.7,0.45,10.7\n"


@pytest.mark.parametrize(
    ("name", "unit", "channel", "found"),
    [
        ("Time (s)", "", "time", "s"),
        ("Load [N]", "", "force", "N"),
        ("P_kPa", "", "pressure", "kPa"),
        ("Position mm", "", "position", "mm"),
        ("Kraft (N)", "", "force", "N"),
        ("Standardkraft", "N", "force", "N"),
        ("Kraft in mN", "", "force", "mN"),
        ("Druck / mbar", "", "pressure", "mbar"),
        ("Crosshead, in", "", "position", "in"),
        ("Digital Position(mm)", "", "position", "mm"),
        ("Force (Ch 1) [lbf]", "", "force", "lbf"),
        ("Pressure (kPa(g))", "", "pressure", "kPa"),
        ("elapsed_ms", "", "time", "ms"),
        ("weight kg", "", "force", "kgf"),
        ("Weg", "(µm)", "position", "um"),
        ("Ch2 [psi]", "", "pressure", "psi"),
        ("millis", "", "time", "ms"),
        ("Injected volume (ml)", "", "volume", "mL"),
        ("Load", "", "force", ""),
        ("Load cell pressure", "kPa", "pressure", "kPa"),
        # Another quantity of the channel, or a unit that is none of the channel.
        ("Load rate (N/s)", "", "", ""),
        ("Crosshead speed", "mm/s", "", ""),
        ("Force setpoint (N)", "", "", "N"),
        ("Pressure (N)", "", "", "N"),
        ("Ambient pressure (kPa)", "", "", "kPa"),
        ("Pressure absolute (kPa)", "", "", "kPa"),
        ("P_abs (kPa)", "", "", "kPa"),
        ("Atmospheric pressure (mbar)", "", "", "mbar"),
        ("Barometric pressure", "kPa", "", "kPa"),
        ("Baro (kPa)", "", "", "kPa"),
        ("Stress (MPa)", "", "", "MPa"),
        ("Spannung (MPa)", "", "", "MPa"),
        ("Modulus (MPa)", "", "", "MPa"),
        ("F target [N]", "", "", "N"),
        ("Force command (N)", "", "", "N"),
        ("Demand (N)", "", "", "N"),
        ("Kraft Sollwert (N)", "", "", "N"),
        ("Force limit (N)", "", "", "N"),
        ("Pressure SP (kPa)", "", "", "kPa"),
        ("Cycle (N)", "", "", "N"),
        ("Cycles", "N", "", "N"),
        ("Pressure (psia)", "", "pressure", "psi_abs"),
        ("Pressure (kPa(a))", "", "pressure", "kPa_abs"),
        ("Pressure (bar abs)", "", "", ""),
        ("Temperature (°C)", "", "", ""),
        ("Strain (%)", "", "", ""),
    ],
)
def test_a_header_tells_channel_and_unit(name, unit, channel, found):
    meaning = meaning_of(name, unit)
    assert (meaning.channel, meaning.unit) == (channel, found)


def test_the_case_of_a_unit_counts_where_it_tells_milli_from_mega():
    assert unit_of("mPa") is None and unit_of("MPa") == ("pressure", "MPa")
    assert unit_of("mN") == ("force", "mN") and unit_of("MN") is None
    assert unit_of("PSI") == ("pressure", "psi") and unit_of("Newton") == ("force", "N")
    assert all(unit_of(unit) == (key, unit) for key, units in UNITS.items() for unit in units)


def asked(tmp_path, header, *texts, body=NUMBERS, columns=ANY):
    path = tmp_path / "a.csv"
    path.write_text(header + "\n" + body, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        identify(path, columns, PLATE)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    for text in texts:
        assert text in message
    return message


def test_two_columns_of_force_are_asked_for(tmp_path):
    asked(
        tmp_path,
        "Time (s),Position (mm),Load 1 (N),Load 2 (N),P_kPa",
        "2 columns may be the force",
        'force = { name = "Load 1 (N)", unit = "N" }  # or "Load 2 (N)"',
        'pressure = { name = "P_kPa", unit = "kPa" }',
        "`columns`",
        body=NUMBERS.replace("10.", "5.5,10."),
    )


def test_words_and_unit_come_before_either_alone(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time (s),Position (mm),Load (N),Ch 7 [N],P_kPa\n" + NUMBERS.replace("10.", "5.5,10."))
    assert identify(path, ColumnMap(), PLATE).columns.force.name == "Load (N)"


def test_a_unit_that_is_not_stated_is_asked_for(tmp_path):
    message = asked(tmp_path, "Time (s),Position (mm),Load,P_kPa", "column Load", "no unit of the force")
    assert 'force = { name = "Load", unit = "?" }  # unit: N, mN, kN, gf, kgf, lbf' in message


def test_a_channel_that_is_missing_is_asked_for(tmp_path):
    asked(tmp_path, "Time (s),Position (mm),Load (N),T (°C)", "column pressure_kPa: missing", "no column of pressure")
    asked(tmp_path, "Time (s),Position (mm),Load (N),Pressure (at)", "no column of pressure")


def test_only_the_gauge_pressure_and_the_measured_force_are_taken(tmp_path):
    path = tmp_path / "a.csv"
    head = "Time (s),Position (mm),F target [N],Force (N),Force limit (N),Ambient pressure (kPa),Pressure (kPa)"
    path.write_text(f"{head}\n0,1.5,9,0.25,20,101,10.5\n1,1.6,9,0.35,20,101,10.6\n2,1.7,9,0.45,20,101,10.7\n")
    columns = identify(path, ColumnMap(), PLATE).columns
    assert (columns.force.name, columns.pressure.name) == ("Force (N)", "Pressure (kPa)")
    asked(tmp_path, "Time (s),Position (mm),Load (N),Ambient pressure (kPa)", "no column of pressure")
    asked(tmp_path, "Time (s),Position (mm),Load (N),Stress (MPa)", "no column of pressure")
    asked(tmp_path, "Time (s),Position (mm),Cycle (N),P_kPa", "no column of force")


def test_a_stated_column_without_unit_takes_that_of_the_header(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time (s),Position (mm),Load 1 (N),Load 2 [lbf],P_kPa\n" + NUMBERS.replace("10.", "5.5,10."))
    columns = ColumnMap.model_validate({"force": {"name": "Load 2 [lbf]"}})
    assert identify(path, columns, PLATE).columns.force.unit == "lbf"
    asked(
        tmp_path,
        "Time (s),Position (mm),Load,P_kPa",
        "column Load: no unit of force in the header",
        columns=ColumnMap.model_validate({"force": {"name": "Load"}}),
    )


def test_a_comma_that_may_be_of_thousands_is_asked_for(tmp_path):
    body = "1;1,234;2,345;10,000\n2;1,235;2,346;10,001\n3;1,236;2,347;10,002\n"
    head = "Time (s);Position (um);Load (mN);P (Pa)"
    asked(tmp_path, head, "1,234: a decimal comma, or one of thousands?", '[format]\ndecimal = ","', body=body)
    path = tmp_path / "a.csv"
    path.write_text(f"{head}\n{body.replace('2,345', '0,345')}")
    assert identify(path, ColumnMap(), PLATE).layout.format.decimal == ","


def test_commas_between_decimal_commas_are_asked_for(tmp_path):
    asked(tmp_path, "Time (s),P_kPa", "2 cells, and 4 in the rows of numbers", "decimal = ", body="0,1,2,3\n0,2,2,4\n")


def test_a_table_without_header_is_asked_for(tmp_path):
    asked(tmp_path, "-1.0,1.5,0.25,10.5", "row 1 holds numbers", "#1 is its first column", "# #1 to #4; unit: N")


def test_columns_of_one_name_are_named_by_their_numbers(tmp_path):
    head, body = "Time (s),Position (mm),Load (N),Load (N),P_kPa", NUMBERS.replace("10.", "5.5,10.")
    asked(tmp_path, head, 'force = { name = "#3", unit = "N" }  # or "#4"', body=body)
    path = tmp_path / "a.csv"
    path.write_text(f"{head}\n{body}")
    columns = identify(path, ColumnMap.model_validate({"force": {"name": "#4"}}), PLATE).columns
    assert (columns.force.name, columns.force.unit) == ("#4", "N")


def test_a_column_without_a_name_has_its_number(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time,,Load,Pressure\ns,mm,N,kPa\n" + NUMBERS)
    assert identify(path, ColumnMap(), PLATE).columns.position.name == "#2"


def test_a_row_of_units_may_hold_others_units(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Time,Position,Load,Pressure,T\ns,mm,N,kPa,degC\n" + NUMBERS.replace("\n", ",22\n"))
    source = identify(path, ColumnMap(), PLATE)
    assert [getattr(source.columns, key).name for key in PLATE] == ["Time", "Position", "Load", "Pressure"]


@pytest.mark.parametrize(
    ("text", "row", "first"),
    [
        ("sep=;\r\nZeit [s];Weg [mm];Kraft [N];Druck [kPa]\r\n0,0;1,5;0,25;10,5\r\n0,1;1,6;0,35;10,6\r\n", 3, 1.5),
        ("Zeit [s];Weg [mm];Kraft [N];Druck [kPa]\n0,0;1,5;0,25;10,5;\n0,1;1,6;0,35;10,6;\n", 2, 1.5),
        (
            "At,Time (s),Pos (mm),F (N),P (kPa)\n2026-01-01 12:00:00,0,1.5,0.2,10\n2026-01-01 12:00:01,1,1.6,0.3,11\n",
            2,
            1.5,
        ),
        ("t (s)\tz (mm)\tF (N)\tp (kPa)\n\n0,0E+00\t1,5E+00\t2,5E-01\t1E+01\n1E-01\t1,6E+00\t2E-01\t1E+01\n", 3, 1.5),
        (",Time (s),Pos (mm),F (N),P (kPa)\n0,0.0,1.5,0.25,10.5\n1,0.1,1.6,0.35,10.6\n", 2, 1.5),
    ],
)
def test_habits_of_spreadsheets_and_programs(tmp_path, text, row, first):
    path = tmp_path / "a.csv"
    path.write_text(text, newline="")
    source = identify(path, ColumnMap(), PLATE)
    lines, values = whole(path, [source.columns.position.name], source.layout)
    assert lines.tolist() == [row, row + 1] and values[0, 0] == first


@pytest.mark.parametrize("text", ["1" * 300_000 + "x", "1." + "1" * 300_000 + "x", "1e" + "1" * 300_000 + "x"])
def test_a_long_run_of_digits_is_looked_at_once(text):
    """A pattern that tries every part of it takes the square of its length: for these hours."""
    assert score([text], ".") < 0.0 and score([text.replace(".", ",")], ",") < 0.0
    with pytest.raises(ValueError, match="is no finite number"):
        plain_number(text)


def test_a_name_of_many_separators_has_no_unit(tmp_path):
    assert meaning_of("_" * 300_000).unit == ""
    path = tmp_path / "pull.csv"
    path.write_text("Specimen Length (mm);33\nA" + ";" * 60_000 + "\nstretch,stress (MPa)\n")
    assert _facts(path) == {"Specimen Length (mm)": "33"}
