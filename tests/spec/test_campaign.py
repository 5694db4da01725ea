"""A campaign holds every file once, however its path is written."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign, campaign_of


def campaign(*files):
    return Campaign.model_validate(
        {"runs": [{"file": file, "sensor": "A1", "resin": "tango-plus", "run": k + 1} for k, file in enumerate(files)]}
    )


@pytest.mark.parametrize("again", ["a-b.csv", "./a-b.csv", "day/../a-b.csv", ".//a-b.csv"])
def test_one_file_in_two_spellings_is_refused(again):
    with pytest.raises(ValidationError, match=r"runs\[1\]\.file = .* is that of runs\[0\] too"):
        campaign("a-b.csv", again)


def test_other_files_are_not():
    runs = campaign("a-b.csv", "day/a-b.csv", "./A-b.csv", "../a-b.csv").runs
    assert [run.file for run in runs] == ["a-b.csv", "day/a-b.csv", "./A-b.csv", "../a-b.csv"]


def test_a_recording_in_the_place_of_a_campaign_is_refused_as_what_it_is(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time_s,position_mm\n0,1\n")
    with pytest.raises(InputError) as caught:
        campaign_of(path)
    assert caught.value.file == str(path) and caught.value.remedy is not None and "plan" in caught.value.remedy
