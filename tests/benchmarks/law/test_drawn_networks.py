"""A network is drawn from its seed, and SUMO's cars get on in it."""

from __future__ import annotations

import filecmp
from pathlib import Path

import pytest
from drawn_networks import draw_network
from road_campaign import in_a_process


@pytest.mark.parametrize("seed", [1, 4])
def test_a_network_is_the_same_again_and_its_cars_depart(tmp_path: Path, seed: int) -> None:
    one, words = draw_network(tmp_path / "one", seed)
    again, the_same = draw_network(tmp_path / "again", seed)
    assert words == the_same
    assert filecmp.cmp(one.parent / "traffic.rou.xml", again.parent / "traffic.rou.xml", False)
    assert len(in_a_process("cars", [str(one), 60.0, seed])) > 20
