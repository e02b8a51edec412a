"""The kept rows of the rivals: complete, of this version, and beside them recorded drivers."""

from itertools import product

from giveway.studies.benchmark import ALL_SCENES, RECORDED, VERSION, rivals, scenes

CONTROLLERS = {
    "mpc": 100,
    "mpc careful": 100,
    "mpc assertive": 100,
    "pid-tuned": 100,
    "idm": 100,
    "careful-driver": 100,
    "bilevel": 20,
}


def test_each_rival_has_a_row_for_each_scene_and_people():
    kept = rivals()
    driven = kept[kept["controller"] != RECORDED]
    found = {*zip(driven["controller"], driven["people"], driven["scene"], strict=True)}
    assert found == {*product(CONTROLLERS, ("MIXED", "SIM"), (*scenes(), ALL_SCENES))}
    assert len(found) == len(driven)
    for row in driven.to_dict("records"):
        pooled = len(scenes()) if row["scene"] == ALL_SCENES else 1
        assert row["drives"] == CONTROLLERS[row["controller"]] * pooled
    assert set(driven["failed"]) == {0}


def test_the_kept_rows_are_of_this_version_and_tell_their_commit():
    kept = rivals()
    assert set(kept["benchmark"]) == {VERSION}
    driven = kept[kept["controller"] != RECORDED]
    known = driven["made_with"].str.fullmatch(r"giveway [\d.]+ at \w{10}\+? \(\d{4}-\d\d-\d\d\)")
    assert known.all()


def test_the_recorded_drivers_are_the_last_row():
    last = rivals().iloc[-1]
    assert last["controller"] == RECORDED
    assert round(last["close_pass_share"] * last["people_near"]) == 6
