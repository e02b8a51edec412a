"""An ego's way with its crossings, lines, junctions and halts, as JSON keeps it."""

import json

import pytest

from giveway.run_data.way import CrossingOnWay, EgoWay, Halt, JunctionOnWay, StopLine

ZEBRA = CrossingOnWay(":J_c0", ((10.0, -3.0), (10.0, 3.0)), 4.0, True, "", -1)
LIT = CrossingOnWay(":K_c1", ((60.0, -3.0), (60.0, 3.0)), 4.0, False, "K", 5)
FULL = EgoWay(
    "ego",
    ((0.0, 0.0), (50.0, 0.0), (80.0, 0.1)),
    departure=5.0,
    crossings=(ZEBRA, LIT),
    lines=(StopLine(48.0, "K", 2),),
    junctions=(JunctionOnWay(50.0, 61.5, (55.0,), stop_sign=True),),
    halts=(Halt(20.0, 22.0),),
)


def test_json_keeps_every_number() -> None:
    line = FULL.to_json()
    assert "\n" not in line
    assert EgoWay.from_dict(json.loads(line)) == FULL


def test_only_what_gives_priority_makes_it_ruled() -> None:
    assert FULL.is_ruled
    assert not EgoWay("ego", FULL.points, halts=FULL.halts).is_ruled


def test_lights_of_crossings_and_of_lines_are_its_systems() -> None:
    assert FULL.systems == {"K"}
    assert EgoWay("ego", FULL.points, crossings=(ZEBRA,)).systems == frozenset()


@pytest.mark.parametrize("key", ["ego", "points", "crossings", "halts"])
def test_a_kept_way_without_a_key_is_refused(key: str) -> None:
    kept = FULL.as_dict()
    del kept[key]
    with pytest.raises(KeyError):
        EgoWay.from_dict(kept)
