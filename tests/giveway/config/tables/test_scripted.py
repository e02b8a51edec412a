"""``[[crowd.scripted]]`` as people write it, right and wrong."""

from __future__ import annotations

import pytest

from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml, read_toml_text
from giveway.config.files.loading import load
from giveway.errors import ConfigError

MODEL = "[crowd]\nmodel = 'recorded'\n"
PERSON = "[[crowd.scripted]]\nx = 90\ny = -4.0\nheading = 90\nspeed = 1.4\n"


def of(text: str) -> RunConfig:
    return load([read_toml_text(text, "my.toml")])[0]


def test_an_entry_is_read_and_written_again():
    config = of(MODEL + PERSON)
    (person,) = config.crowd.scripted
    assert (person.name, person.x, person.distance) == ("scripted0", 90.0, 20.0)
    assert config.crowd.adds_people
    assert load([read_toml_text(dump_toml(config), "again")])[0] == config


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (PERSON, "model = 'vci' does not know scripts; expected model = 'recorded'"),
        (MODEL + "scripted = 3", "scripted = 3: expected tables, each headed [[crowd.scripted]]"),
        (MODEL + "[[crowd.scripted]]\nx = 1\ny = 1", "scripted 'scripted0': speed is missing"),
        (MODEL + PERSON + "pace = 2", "unknown key 'pace'; expected one of name, x, y"),
        (MODEL + PERSON + "distance = -1", "distance = -1"),
        (MODEL + PERSON + "meet_after = 30", "meet_after = 30: expected at most the distance"),
        (MODEL + PERSON + "kind = 'dog'", "kind = 'dog'"),
        (MODEL + (PERSON + "name = 'a'\n") * 2, "scripted 'a': two have this name"),
        (MODEL + PERSON * 21, "21 scripted people: expected 20 at most"),
    ],
)
def test_a_wrong_entry_is_one_line(text, said):
    with pytest.raises(ConfigError) as error:
        of(text)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
