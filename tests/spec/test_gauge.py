"""Gauges: every shipped part, its transfer function and reference, and what is wrong with a bad file."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.spec.gauge import FIGURES, Gauge
from pneutouch.spec.read import validate
from tests.refusals import refused

GAUGES = Library.default().all("gauges", Gauge)
LINEAR = {name: gauge for name, gauge in GAUGES.items() if gauge.transfer.output != "compensated"}


def content(name: str = "honeywell-abp2-5psi") -> dict:
    return tomllib.loads(Library.default().paths("gauges")[name].read_text(encoding="utf-8"))


def changed(table: str, key: str | None = None, value: object = None) -> dict:
    """The content of a good file with one entry changed, or without it where ``value`` is None."""
    result = content()
    holder, last = (result, table) if key is None else (result.setdefault(table, {}), key)
    holder[last] = value
    if value is None:
        del holder[last]
    return result


@pytest.mark.parametrize("name", GAUGES)
def test_a_shipped_gauge_states_every_figure_or_what_was_searched_for_it(name):
    gauge = GAUGES[name]
    assert {key for key in FIGURES if getattr(gauge, key) is None} == set(gauge.unknown)


@pytest.mark.parametrize("name", LINEAR)
@given(share=st.floats(0, 1))
def test_output_and_pressure_are_inverse_and_meet_both_ends_of_the_range(name, share):
    gauge = LINEAR[name]
    pressure = gauge.range_kPa.low + share * gauge.range_kPa.span
    assert gauge.pressure_kPa(gauge.output(pressure)) == pytest.approx(pressure, abs=1e-9 * gauge.range_kPa.span)
    assert gauge.output(gauge.range_kPa.low) == pytest.approx(gauge.transfer.at_low)
    assert gauge.output(gauge.range_kPa.high) == pytest.approx(gauge.transfer.at_high)


def test_a_compensated_output_has_no_transfer_function():
    with pytest.raises(ValueError, match="constants stored in each part"):
        GAUGES["bosch-bmp390"].pressure_kPa(1.0)


@given(ambient=st.floats(20, 110))
def test_an_absolute_gauge_reads_ambient_and_gauge_pressure(ambient):
    for gauge in GAUGES.values():
        low, high = gauge.gauge_pressures_kPa(ambient)
        shift = ambient if gauge.is_absolute else 0.0
        assert (low + shift, high + shift) == pytest.approx((gauge.range_kPa.low, gauge.range_kPa.high))


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (changed("noise_kPa", "value", -0.1) | {"unknown": {}}, "noise_kPa"),
        (changed("error_kPa", "value", -1), "error_kPa: value = -1: must be from 0 to 10000 kPa"),
        (changed("rate_Hz", "value", 0), "rate_Hz: value = 0: must be from 0.01 to 1e+06 Hz"),
        (changed("rate_Hz", "source"), "rate_Hz.source"),
        (changed("range_kPa", "high", -3), "must be above low and above 0"),
        (changed("range_kPa"), "range_kPa"),
        (changed("reference", None, "sealed"), "reference"),
        (
            changed("reference", None, "absolute") | {"range_kPa": {"low": -1, "high": 9, "source": "made up here"}},
            "below 0",
        ),
        (changed("transfer", "at_high", 1677721.6), "two different outputs"),
        (changed("transfer", "output", "compensated"), "must be left out"),
        (changed("interfaces", None, []), "interfaces"),
        (changed("i2c_address", None, 3), "i2c_address"),
        (changed("unknown", "volume", "nowhere"), "no figure of a gauge"),
        (changed("unknown", "rate_Hz", "nowhere"), "give one of both"),
        (changed("resolution", None, 3), "resolution"),
    ],
)
def test_a_bad_gauge_names_file_and_key(bad, message):
    with pytest.raises(InputError) as raised:
        validate(Gauge, bad, "gauges/bad.toml")
    assert "gauges/bad.toml" in str(raised.value) and message in str(raised.value)


def test_a_design_resolves_its_gauge_and_has_none_where_it_names_none():
    assert load_scene("paper-dome").gauge is None
    assert load_scene("paper-dome", {"pneumatics.gauge": "smc-pse543"}).gauge == GAUGES["smc-pse543"]
    with pytest.raises(InputError, match=r'pneumatics.gauge = "pse543".*no such name among the gauges'):
        load_scene("paper-dome", {"pneumatics.gauge": "pse543"})


def test_a_gauge_that_ends_below_the_ambient_pressure_is_refused():
    with refused("pneumatics.gauge", "bosch-bmp390"):
        load_scene("paper-dome", {"pneumatics.gauge": "bosch-bmp390", "pneumatics.ambient_pressure_kPa": 130})


def test_a_gauge_in_the_users_folder_comes_first(tmp_path, monkeypatch):
    folder = tmp_path / "printprofiles/gauges"
    folder.mkdir(parents=True)
    text = Library.default().paths("gauges")["smc-pse543"].read_text(encoding="utf-8")
    (folder / "smc-pse543.toml").write_text(text.replace("SMC PSE543-R06", "ours"), encoding="utf-8")
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    assert load_scene("paper-dome", {"pneumatics.gauge": "smc-pse543"}).gauge.title == "ours"


def test_a_design_without_a_gauge_is_written_as_before():
    assert "gauge" not in load_scene("paper-dome").design.model_dump()["pneumatics"]
