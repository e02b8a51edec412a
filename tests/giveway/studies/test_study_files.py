"""Bundled studies: all can be planned, and an unknown one names them."""

from pathlib import Path

import pytest

from giveway.errors import ConfigError
from giveway.studies.definition import (
    parse_definition,
    read_definition,
)
from giveway.studies.study_files import bundled_studies, find_study


def parsed(text, folder=None, tmp="."):
    return parse_definition(text, "mine.toml", folder or Path(tmp))


@pytest.mark.parametrize("name", bundled_studies())
def test_every_bundled_study_can_be_planned(name):
    from giveway.studies.plan import plan

    planned = plan(read_definition(find_study(name)), name)
    assert len(planned) == len(planned.cells) * planned.definition.replications
    assert len({cell.digest for cell in planned.cells}) == len(planned.cells)
    people = {"paper": "SIM", "readings": "SIM"}.get(name, "MIXED")
    for cell in planned.cells:
        scene = " ".join(level.label for level in cell.cell.levels.values())
        own = [preset for preset in ("SIM", "TABLE2") if f"{preset} crowd" in scene]
        own += ["TABLE2"] * ("VCI preset TABLE2" in scene)
        assert cell.config.crowd.preset == (own or [people])[0], scene


@pytest.mark.parametrize("name", bundled_studies())
def test_every_bundled_study_names_its_primary_outcome(name):
    outcome = read_definition(find_study(name)).primary_outcome
    assert outcome is not None
    assert len(outcome.reason.split()) > 5
    page = (Path(__file__).parents[3] / "docs" / "studies.md").read_text("utf-8")
    row = f"| `{name}` | `{outcome.metric}` | {outcome.smallest_effect:g}"
    assert any(line.startswith(row) and outcome.reason in line for line in page.split("\n"))


def test_an_unknown_study_names_the_known_ones():
    known = "ablation, beliefs, controllers, law, models, paper, readings, styles"
    with pytest.raises(ConfigError, match=rf"expected a \.toml file or one of {known}"):
        find_study("papper")


def planned(text):
    from giveway.studies.plan import plan

    return plan(parsed(text), "mine.toml")
