"""Crossings and stop lines, as a results folder keeps them."""

from __future__ import annotations

import pytest

from giveway.run_data.road_marks import UNMARKED, RoadMarks, SignalHead, Zebra, shown
from giveway.run_data.scene import SCENE_FILE, Scene

MARKS = RoadMarks(
    (Zebra(((0.0, -3.5), (0.0, 3.5)), 4.0), Zebra(((50.0, 0.0), (50.0, 7.0)), 3.0)),
    (SignalHead(((-3.0, 0.0), (-3.0, -3.5)), "centre", (4, 5)),),
)


def test_a_scene_keeps_them(tmp_path):
    (tmp_path / SCENE_FILE).write_text(Scene((), {}, (), MARKS).to_json())
    assert Scene.read(tmp_path).marks == MARKS


def test_a_scene_without_any_says_nothing_of_them(tmp_path):
    text = Scene((), {}).to_json()
    assert "zebras" not in text
    assert "heads" not in text
    (tmp_path / SCENE_FILE).write_text(text)
    assert Scene.read(tmp_path).marks == UNMARKED


def test_those_within_a_rectangle():
    near = MARKS.within((-10.0, -5.0), (10.0, 5.0))
    assert near.zebras == MARKS.zebras[:1]
    assert near.heads == MARKS.heads
    assert MARKS.within((100.0, 100.0), (110.0, 110.0)) == UNMARKED


@pytest.mark.parametrize(
    ("letters", "letter"),
    [("rG", "G"), ("rg", "G"), ("ry", "y"), ("u", "y"), ("rr", "r"), ("O", ""), ("", "")],
)
def test_one_colour_for_a_lane(letters, letter):
    assert shown(letters) == letter
