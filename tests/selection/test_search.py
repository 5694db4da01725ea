"""One answer to a target of any kind."""

import pytest

from pneutouch.errors import InputError
from pneutouch.results.record import plain
from pneutouch.spec.target import Target
from pneutouch.workflows.select.search import search

TARGET = {"sensitivity_kPa_per_N": 1.9, "driving_pressure_kPa": 12.0, "force_range_N": 12.0}


@pytest.mark.slow
@pytest.mark.parametrize(
    "setting", [{}, {"gauge": "any"}, {"processes": ["polyjet"]}], ids=["plain", "gauge", "processes"]
)
def test_the_choices_of_an_answer_are_the_designs_of_its_record(setting, library, tmp_path):
    """Each choice, written as a file, is a design with the sizes that the record gives it."""
    steps = []
    given = {"materials": ["TangoPlus"], "inner_radius_mm": 9.25}
    target = Target.model_validate({"target": TARGET, "given": given, "setting": setting})
    found = search(target, "here.toml", library, progress=lambda done, total, step: steps.append((done, total, step)))
    record = plain(found.record)
    if "processes" in setting:
        record = record["processes"]["polyjet"]
        assert [choice.label for choice in found.choices] == ["polyjet"]
    else:
        assert [choice.label for choice in found.choices] == [str(one["rank"]) for one in record["designs"]]
    assert record["met"] and found.rejected is None
    assert found.choices[0].assignments == record["designs"][0]["set"]
    assert all(0 <= done < total for done, total, _ in steps) and {step for _, _, step in steps}
    text = found.pick(1).write("found", tmp_path).read_text(encoding="utf-8")
    assert f"wall_thickness_mm = {record['designs'][0]['wall_thickness_mm']:g}" in text
    with pytest.raises(InputError) as caught:
        found.pick(len(found.choices) + 1)
    assert (caught.value.key, caught.value.value) == ("pick", len(found.choices) + 1)
