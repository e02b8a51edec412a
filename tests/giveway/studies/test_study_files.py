"""Bundled studies: all can be planned, and an unknown one names them."""

import pytest

from giveway.errors import ConfigError
from giveway.studies.definition import (
    parse_definition,
    read_definition,
)
from giveway.studies.study_files import bundled_studies, find_study


def parsed(text, folder=None, tmp="."):
    from pathlib import Path

    return parse_definition(text, "mine.toml", folder or Path(tmp))


@pytest.mark.parametrize("name", bundled_studies())
def test_every_bundled_study_can_be_planned(name):
    from giveway.studies.plan import plan

    planned = plan(read_definition(find_study(name)), name)
    assert len(planned) == len(planned.cells) * planned.definition.replications
    assert len({cell.digest for cell in planned.cells}) == len(planned.cells)


def test_an_unknown_study_names_the_known_ones():
    known = "ablation, beliefs, controllers, law, models, paper, readings, styles"
    with pytest.raises(ConfigError, match=rf"expected a \.toml file or one of {known}"):
        find_study("papper")


def planned(text):
    from giveway.studies.plan import plan

    return plan(parsed(text), "mine.toml")
