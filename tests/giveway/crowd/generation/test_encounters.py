"""Crowds that meet the drive that an ego would make with nobody about."""

import numpy as np
import pytest

from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import PeopleConfig
from giveway.crowd.generation.encounters import FreeDrive
from giveway.crowd.generation.spawn import Spawned, spawn
from giveway.errors import CrowdError
from giveway.geometry.path import EgoPath

PATH = EgoPath.through([(-20, 0), (120, 0)])
DRIVE = FreeDrive(PATH, 22.5, 60.0, 4.0)
FRONT = 2.5  # [m] its x at departure


def drawn(people: int, seed: int, drive: FreeDrive | None = DRIVE, **crowd) -> Spawned:
    config = CrowdConfig(sampler="encounters", pedestrians=people, **crowd)
    return spawn(config, PATH, seed, drive=drive)


def delays(people: Spawned) -> np.ndarray:
    """(n,) [s] how much later than the free ego each is on its way, if he walks straight on."""
    way = people.destination - people.position
    share = -people.position[:, 1] / way[:, 1]
    place = people.position + share[:, None] * way
    walked = share * np.hypot(*way.T)
    return walked / people.desired_speed - (place[:, 0] - FRONT) / 4.0


def test_equal_seeds_draw_equal_people_and_others_other_people() -> None:
    first, again, other = drawn(24, 5), drawn(24, 5), drawn(24, 6)
    assert first.position.tobytes() == again.position.tobytes()
    assert first.ids == tuple(f"ped{i}" for i in range(24))
    assert not np.array_equal(first.position, other.position)


@pytest.mark.parametrize("people", [1, 12, 24, 48])
def test_the_number_asked_for_keeps_apart_and_has_both_sides(people: int) -> None:
    for seed in range(1, 11):
        crowd = drawn(people, seed, minimum_spacing=0.6)
        assert len(crowd.position) == len(crowd.desired_speed) == people
        offsets = crowd.position[:, None] - crowd.position[None]
        apart = np.hypot(offsets[..., 0], offsets[..., 1])[np.triu_indices(people, 1)]
        assert (apart >= 0.6).all()
        if people >= 12:
            assert set(np.sign(crowd.position[:, 1])) == {-1.0, 1.0}


def test_everybody_crosses_and_somebody_meets_the_free_ego() -> None:
    for seed in range(1, 31):
        crowd = drawn(12, seed)
        assert (np.sign(crowd.position[:, 1]) == -np.sign(crowd.destination[:, 1])).all()
        late = delays(crowd)
        assert late.min() > -8.0  # behind a group's middle a second row comes later still
        assert late.max() < 12.0
        assert ((late > -3.5) & (late < 2.0)).any()


def test_groups_walk_at_one_speed_and_are_five_at_most() -> None:
    sizes = []
    for seed in range(1, 41):
        _, counts = np.unique(drawn(24, seed).desired_speed, return_counts=True)
        sizes += counts.tolist()
    assert max(sizes) == 5
    assert np.mean(sizes) == pytest.approx(1.11 / (1 - np.exp(-1.11)), abs=0.1)


def test_groups_follow_a_way_that_bends() -> None:
    bend = EgoPath.through([(0, 0), (30, 0), (30, 60)])
    crowd = drawn(40, 3, FreeDrive(bend, 0.0, 80.0, 4.0))
    stations, _ = bend.project(0.5 * (crowd.position + crowd.destination))
    assert (stations > 30.0).any()


def test_a_way_too_short_to_meet_anybody_is_refused() -> None:
    with pytest.raises(CrowdError, match="drives 10 m: expected at least 16 m"):
        drawn(12, 1, FreeDrive(PATH, 22.5, 10.0, 4.0))


def test_people_need_a_drive_to_meet() -> None:
    with pytest.raises(CrowdError, match="--ego-route"):
        drawn(12, 1, None)


def test_too_many_for_the_way_are_refused() -> None:
    with pytest.raises(CrowdError, match="find room"):
        drawn(400, 1, minimum_spacing=5.0)


def test_mixed_groups_walk_at_the_speed_of_their_slowest_member() -> None:
    old, mixed = (
        [
            spawn(
                CrowdConfig(
                    sampler="encounters", pedestrians=48, people=PeopleConfig(elderly=share)
                ),
                PATH,
                seed,
                drive=DRIVE,
            )
            for seed in range(1, 21)
        ]
        for share in (1.0, 0.5)
    )
    assert {kind for crowd in old for kind in crowd.kinds} == {"elderly"}
    assert {kind for crowd in mixed for kind in crowd.kinds} == {"adult", "elderly"}
    speeds = [np.mean([crowd.desired_speed.mean() for crowd in crowds]) for crowds in (old, mixed)]
    assert 0.9 < speeds[0] < speeds[1] < 1.3
    for crowd in mixed:
        for name in set(crowd.groups) - {""}:
            rows = [i for i, group in enumerate(crowd.groups) if group == name]
            assert len(rows) >= 2
            assert np.ptp(crowd.desired_speed[rows]) == 0.0
