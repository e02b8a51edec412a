"""``[[crowd.flow]]`` and ``[crowd.people]`` as people write them, right and wrong."""

from __future__ import annotations

import tomllib

import pytest

from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml, read_toml_text
from giveway.config.files.loading import as_layer, load
from giveway.errors import ConfigError

FLOW = """
[[crowd.flow]]
name = "north"
from = [[20, -14], [32, -14]]
to = [20, 12, 32, 14]
via = [[26, 0], [[18, 3], [30, 3]]]
rate = 1200
begin = -60
end = 30
people = { child = 1.0 }
groups = 0.5
[[crowd.flow]]
from = [0, 0, 5, 5]
to = [9.5, 2]
rate = 1
"""


def of(text: str) -> RunConfig:
    return load([read_toml_text(text, "my.toml")])[0]


def test_a_flow_is_read_as_it_is_written() -> None:
    north, other = of(FLOW).crowd.flow
    assert north.start == ((20.0, -14.0), (32.0, -14.0))
    assert north.via == ((26.0, 0.0), ((18.0, 3.0), (30.0, 3.0)))
    assert (north.rate, north.begin, north.end, north.groups) == (1200.0, -60.0, 30.0, 0.5)
    assert north.people is not None
    assert north.people.child == 1.0
    assert (other.name, other.begin, other.end, other.people) == ("flow1", 0.0, None, None)
    assert other.to == (9.5, 2.0)


def test_what_is_written_down_reads_as_the_same() -> None:
    config = of(FLOW + "[crowd.people]\nelderly = 0.25\n")
    assert load([read_toml_text(dump_toml(config), "again")])[0] == config
    assert RunConfig.model_validate_json(config.model_dump_json()) == config
    assert load([as_layer(config)])[0] == config
    assert "people" in tomllib.loads(dump_toml(config))["crowd"]["flow"][0]


def test_shares_add_up_over_layers() -> None:
    layers = [as_layer({"crowd.people.elderly": 0.3}), as_layer({"crowd.people.distracted": 0.2})]
    people = load(layers)[0].crowd.people
    assert people.shares == {"child": 0.0, "elderly": 0.3, "distracted": 0.2, "hurried": 0.0}


PLACES = "from = [0,0,1,1]\nto = [5,5]\n"
WRONG = {
    "flow = 3": "expected tables, each headed [[crowd.flow]]",
    'flow = ["north"]': "expected tables, each headed [[crowd.flow]]",
    "[[flow]]": "from is missing (Place where people appear",
    f"[[flow]]\n{PLACES}": "rate is missing",
    f"[[flow]]\n{PLACES}rate = 0": "should be greater than 0 [persons/h]",
    f"[[flow]]\n{PLACES}rate = 1e9": "should be at most 50000",
    f"[[flow]]\n{PLACES}rate = nan": "rate = nan: should be a finite number",
    f"[[flow]]\n{PLACES}rate = 'many'": "rate = 'many': should be a number",
    f"[[flow]]\n{PLACES}rate = 1\nbegin = -7200": "begin = -7200: should be at least",
    f"[[flow]]\n{PLACES}rate = 1\nbegin = 5\nend = 5": "end = 5: expected later than begin = 5",
    f"[[flow]]\n{PLACES}rate = 1\nspeed = 1": "unknown key 'speed'; expected one of name, from, to",
    f"[[flow]]\n{PLACES}rate = 1\nstart = [0,0,1,1]": "unknown key 'start'",
    f"[[flow]]\n{PLACES}rate = 1\nname = 'a b'": "name = 'a b'",
    f"[[flow]]\n{PLACES}rate = 1\nname = ['a']": "name = ['a']: should be a text",
    f"[[flow]]\n{PLACES}rate = 1\npeople = 'old'": "people = 'old'",
    f"[[flow]]\n{PLACES}rate = 1\npeople = {{ kid = 1 }}": "unknown key 'kid'; expected one",
    f"[[flow]]\n{PLACES}rate = 1\npeople = {{ child = 2 }}": "people.child = 2: should be",
    f"[[flow]]\n{PLACES}rate = 1\npeople = {{ child = 1, elderly = 1 }}": "shares that come to 1",
    f"[[flow]]\n{PLACES}rate = 1\nvia = [1, 2]": "via = [1, 2]: expected a list of points",
    f"[[flow]]\n{PLACES}rate = 1\nvia = 'there'": "via = 'there': expected a list of points",
    f"[[flow]]\n{PLACES}rate = 1\nname='a'\n[[flow]]\n{PLACES}rate = 1\nname='a'": "two have this",
    "[[flow]]\nfrom = [0,0]\nto = [5,5]\nrate = 1": "from = [0, 0]: expected a line",
    "[[flow]]\nfrom = [1,0,0,1]\nto = [5,5]\nrate = 1": "expected x_min < x_max and y_min < y_max",
    "[[flow]]\nfrom = [[1,1],[1,1]]\nto = [5,5]\nrate = 1": "expected two ends, 0.01 apart",
    "[[flow]]\nfrom = [0,0,1,1]\nto = [1e9,5]\nrate = 1": "to = [1000000000.0, 5]: expected",
    "[[flow]]\nfrom = [0,0,1,true]\nto = [5,5]\nrate = 1": "from = [0, 0, 1, True]: should be",
    "[people]\nchild = 0.7\nhurried = 0.7": "child = 0.7, hurried = 0.7: expected shares",
    "[people]\nadult = 0.7": "adult: unknown key",
    "groups = 1.5": "groups = 1.5: should be at most 1: it is a share",
    "flow_scale = -1": "flow_scale = -1: should be at least 0",
}


@pytest.mark.parametrize(("text", "expected"), WRONG.items())
def test_what_cannot_be_is_refused_in_one_line(text: str, expected: str) -> None:
    crowd = text.replace("[[flow]]", "[[crowd.flow]]").replace("[people]", "[crowd.people]")
    with pytest.raises(ConfigError) as refusal:
        of(crowd if "[crowd" in crowd else f"[crowd]\n{crowd}")
    message = str(refusal.value)
    assert message.startswith("my.toml: [crowd")
    assert expected in message
    assert "\n" not in message
