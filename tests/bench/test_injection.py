"""Air pushed into a closed line, and a line left to itself, against Boyle's law and known leaks."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.reading import INJECTION, dead_volume_of_cap, leak_rate, read_injection
from pneutouch.bench.source import identify
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Column, ColumnMap
from pneutouch.units import KPA, ML
from tests.refusals import refused

AMBIENT = 101.325 * KPA
COLUMNS = ColumnMap()


def table(tmp_path, volume, pressure, header="volume_mL,pressure_kPa"):
    path = tmp_path / "injection.csv"
    path.write_text(header + "\n" + "".join(f"{v:.6g},{p:.6g}\n" for v, p in zip(volume, pressure, strict=True)))
    return path


def test_a_cap_gives_back_its_volume(tmp_path):
    injected = np.linspace(0, 0.5, 11)
    pressure = 101.325 * injected / 2.6 + 0.4  # kPa, with the gauge's zero off
    volume, read = read_injection(identify(table(tmp_path, injected, pressure), COLUMNS, INJECTION))
    assert volume == pytest.approx(injected * ML) and read == pytest.approx(pressure * KPA, rel=1e-5)
    result = dead_volume_of_cap(volume, read, AMBIENT)
    assert result.value == pytest.approx(2.6 * ML, rel=1e-4) and result.error < 1e-3 * ML


def test_its_error_is_that_of_many_trials():
    rng, volume = np.random.default_rng(4), np.linspace(0, 500, 11)
    result = [
        dead_volume_of_cap(volume, AMBIENT * volume / 2600 + rng.normal(0, 0.1 * KPA, 11), AMBIENT) for _ in range(3000)
    ]
    values = np.array([one.value for one in result])
    assert values.mean() == pytest.approx(2600, rel=2e-3)
    assert np.sqrt(np.mean([one.spread**2 for one in result])) == pytest.approx(values.std(), rel=0.05)


def test_units_of_an_injection(tmp_path):
    path = table(tmp_path, [0, 100, 200, 300], [0, 40, 81, 120], "uL,mbar")
    columns = ColumnMap(volume=Column(name="uL", unit="uL"), pressure=Column(name="mbar", unit="mbar"))
    volume, pressure = read_injection(identify(path, columns, INJECTION))
    assert volume.tolist() == [0, 100, 200, 300] and pressure == pytest.approx(np.array([0, 4, 8.1, 12]) * KPA)


@pytest.mark.parametrize(
    ("volume", "pressure", "words"),
    [
        ([0, 0.1], [0, 4], "2 rows; at least 3"),
        ([0.1, 0.1, 0.1], [0, 4, 5], "volume_mL: does not vary"),
        ([0, 0.1, 0.2], [4, 4, 4], "pressure_kPa: does not rise"),
        ([0, 0.1, 0.2], [8, 4, 0], "pressure_kPa: does not rise"),
        ([0, 0.1, 0.2], [101, 105, 109], "pressure=pressure_kPa:kPa_abs"),
    ],
)
def test_tables_that_cannot_be(tmp_path, volume, pressure, words):
    path = table(tmp_path, volume, pressure)
    with pytest.raises(InputError) as caught:
        read_injection(identify(path, COLUMNS, INJECTION))
    assert str(caught.value).startswith(f"{path}: ") and words in str(caught.value)


def test_a_missing_column_is_named(tmp_path):
    with refused("column volume_mL"):
        read_injection(identify(table(tmp_path, [0, 1, 2], [0, 1, 2], "Mass_g,pressure_kPa"), COLUMNS, INJECTION))


def leak_samples(rng, constant=3600.0, noise=0.05, size=60_000):
    time = np.arange(size) / 100.0
    return time, 22 * KPA * np.exp(-time / constant) + rng.normal(0, noise * KPA, size)


def test_a_leak_gives_back_its_rate():
    rate, error = leak_rate(*leak_samples(np.random.default_rng(1)))
    # The slope of a straight line through an exponential is that in its middle, to second order.
    assert rate == pytest.approx(22 * KPA / 3600 * np.exp(-300 / 3600), rel=2e-3) and 0 < error < 0.01 * rate
    with pytest.raises(InputError, match="points"):
        leak_rate(np.arange(5.0), np.arange(5.0))


def test_the_error_of_a_leak_covers_it():
    rng, time = np.random.default_rng(8), np.arange(2000) / 10.0
    inside = 0
    for _ in range(400):
        # Noise that is alike over 20 samples, as a filtered gauge's.
        noise = np.repeat(rng.normal(0, 0.05 * KPA, 100), 20)
        rate, error = leak_rate(time, 22 * KPA - 2e-3 * KPA * time + noise)
        # Student's t at 97.5 % with 8 degrees of freedom (NIST/SEMATECH e-Handbook, 1.3.6.7.2).
        inside += abs(rate - 2e-3 * KPA) <= 2.306 * error
    assert 0.92 * 400 <= inside <= 0.985 * 400


@pytest.mark.parametrize("end", ["", "\n", "\r\n"])
def test_the_last_row_of_a_typed_table_counts(tmp_path, end):
    path = tmp_path / "injection.csv"
    path.write_text("volume_mL,pressure_kPa\n0,0\n0.1,4\n0.2,8\n0.5,19.5" + end, newline="")
    volume, pressure = read_injection(identify(path, COLUMNS, INJECTION))
    assert volume == pytest.approx(np.array([0, 0.1, 0.2, 0.5]) * ML) and pressure[-1] == pytest.approx(19.5 * KPA)
    path.write_text("volume_mL,pressure_kPa\n0,0\n0.1,4\n0.2,8\n0.5,")
    with refused("row 5"):
        read_injection(identify(path, COLUMNS, INJECTION))


def test_volumes_that_overflow_are_named(tmp_path):
    path = tmp_path / "injection.csv"
    path.write_text("volume_mL,pressure_kPa\n0,0\n0.1,4\n3e307,8\n")
    with pytest.raises(InputError, match="row 4: column volume_mL: 3e\\+307 mL: no instrument reads that"):
        read_injection(identify(path, COLUMNS, INJECTION))
