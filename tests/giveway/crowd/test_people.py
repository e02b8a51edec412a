"""Who people are: kinds, groups, and how these walk."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import PeopleConfig
from giveway.crowd.generation.groups import formation, party_sizes, slowest
from giveway.crowd.generation.kinds import desired_speeds, draw_kinds
from giveway.crowd.generation.spawn import spawn
from giveway.crowd.models import model_of
from giveway.crowd.motion.attention import Inattentive, distance_to_next
from giveway.crowd.motion.cohesion import Cohesive, attraction
from giveway.crowd.roster import Roster, Trait
from giveway.geometry.path import EgoPath
from pedestrian_model import PLAIN_MODELS, SIM, Crowd, CrowdModel, PlainModel, Vehicles

STEP = 0.05
MANY = 20_000
AXIS = EgoPath.through([(-20, 0), (100, 0)])


def test_kinds_are_drawn_by_their_shares_and_the_rest_are_adults() -> None:
    people = PeopleConfig(elderly=0.2, distracted=0.3)
    kinds = np.array(draw_kinds(people, MANY, np.random.default_rng(1)))
    shares = {name: float(np.mean(kinds == name)) for name in np.unique(kinds)}
    assert shares == pytest.approx({"adult": 0.5, "elderly": 0.2, "distracted": 0.3}, abs=0.015)
    everybody = draw_kinds(PeopleConfig(child=1.0), 5, np.random.default_rng(1))
    assert everybody == ("child",) * 5


def test_without_a_mixture_there_are_no_kinds_and_no_draws() -> None:
    random = np.random.default_rng(1)
    assert draw_kinds(PeopleConfig(), 3, random) == ("", "", "")
    assert random.random() == np.random.default_rng(1).random()


@pytest.mark.parametrize(
    ("kind", "mean", "slow"),
    [  # the mean, and the 15th percentile where one is published [m/s]
        ("", 1.394, 1.394 - 0.26 * 1.036),
        ("adult", 1.394, 1.394 - 0.26 * 1.036),
        ("elderly", 3.81 * 0.3048, 3.02 * 0.3048),  # Gates et al. 2006
        ("child", 3.81 * 0.3048, 3.02 * 0.3048),
        ("distracted", 1.394 / 1.18, (1.394 - 0.26 * 1.036) / 1.18),  # Thompson et al. 2013
        ("hurried", 1.61, 1.61 - 0.26 * 1.036),  # Weidmann 1993
    ],
)
def test_each_kind_walks_as_was_measured(kind: str, mean: float, slow: float) -> None:
    speeds = desired_speeds(CrowdConfig(), (kind,) * MANY, np.random.default_rng(2))
    assert speeds.mean() == pytest.approx(mean, abs=0.015)
    assert np.percentile(speeds, 15.0) == pytest.approx(slow, abs=0.02)
    assert speeds.min() >= 0.5
    assert speeds.max() <= 2.2


def test_mixed_people_stand_where_an_unmixed_crowd_does() -> None:
    mixed = spawn(CrowdConfig(pedestrians=40, people=PeopleConfig(elderly=0.5)), AXIS, 3)
    plain = spawn(CrowdConfig(pedestrians=40), AXIS, 3)
    assert np.array_equal(mixed.position, plain.position)
    assert set(mixed.kinds) == {"adult", "elderly"}
    assert plain.kinds == ("",) * 40
    assert plain.traits == {}
    assert mixed.traits["ped0"] == Trait(mixed.kinds[0], "")


def test_sizes_of_groups_are_zero_truncated_poisson() -> None:
    sizes = np.array(party_sizes(MANY, 0.6, np.random.default_rng(1)))
    grouped = sizes[sizes > 1]
    assert grouped.sum() / sizes.sum() == pytest.approx(0.6, abs=0.02)
    assert grouped.max() == 5
    ratio = np.mean(grouped == 3) / np.mean(grouped == 2)
    assert ratio == pytest.approx(1.11 / 3.0, abs=0.03)  # lambda^3/3! over lambda^2/2!
    assert sum(sizes) == MANY


def test_up_to_three_walk_abreast_and_larger_groups_in_two_rows() -> None:
    for size in (1, 2, 3):
        assert np.ptp(formation(size)[:, 1]) == 0.0
    assert np.ptp(formation(4)[:, 1]) == 1.0
    assert slowest(np.array([1.0, 1.5, 1.2]), [1, 2]).tolist() == [1.0, 1.2, 1.2]


def test_groups_start_together_and_share_speed_and_way() -> None:
    config = CrowdConfig(pedestrians=40, groups=0.8, two_sided=True, minimum_spacing=0.5)
    crowd = spawn(config, AXIS, 5)
    x_min, y_min, x_max, y_max = config.spawn_area
    assert ((crowd.position[:, 0] >= x_min) & (crowd.position[:, 0] <= x_max)).all()
    assert (np.abs(crowd.position[:, 1]) <= -y_min).all()
    assert (np.abs(crowd.position[:, 1]) >= -y_max).all()
    groups = {group for group in crowd.groups if group}
    assert len(groups) >= 5
    for group in groups:
        rows = [i for i, own in enumerate(crowd.groups) if own == group]
        assert crowd.ids[rows[0]] == group
        assert np.ptp(crowd.desired_speed[rows]) == 0.0
        way = crowd.destination[rows] - crowd.position[rows]
        assert np.abs(np.diff(way, axis=0)).max() < 1e-9
        assert np.abs(np.diff(crowd.position[rows], axis=0)).max() <= 1.51


# --- attention --------------------------------------------------------------------------------

CAR = Vehicles.create(0.0, 0.0, 0.0, 2.0, front=2.5, rear=2.5, width=2.0)


def before_a_car() -> Crowd:
    """Two who walk towards the way of a car that comes: 3 m and 1 m from its front and side."""
    return Crowd.create(
        [(5.5, -1.0), (1.0, -2.0)], [(0.0, 1.3)] * 2, 1.3, [[(5.5, 20.0)], [(1.0, 20.0)]]
    )


def models() -> list:
    return [CrowdModel(SIM, STEP), *(PlainModel(name, SIM, STEP) for name in PLAIN_MODELS)]


@pytest.mark.parametrize("model", models(), ids=["vci", *PLAIN_MODELS])
def test_who_is_distracted_feels_no_vehicle_until_it_is_near(model) -> None:
    feeling, alone, distracted = before_a_car(), before_a_car(), before_a_car()
    model.advance(feeling, CAR)
    model.advance(alone, Vehicles.empty())
    Inattentive(model, lambda: np.array([True, True])).advance(distracted, CAR)
    assert np.array_equal(distracted.velocity[0], alone.velocity[0])
    assert np.array_equal(distracted.position[0], alone.position[0])
    assert np.array_equal(distracted.velocity[1], feeling.velocity[1])  # 1 m from it
    if model.__class__ is CrowdModel:
        assert not np.array_equal(feeling.velocity[0], alone.velocity[0])  # and it would matter


def test_without_distracted_people_the_model_is_unchanged() -> None:
    model = CrowdModel(SIM, STEP)
    plain, wrapped = before_a_car(), before_a_car()
    model.advance(plain, CAR)
    Inattentive(model, lambda: np.array([False, False])).advance(wrapped, CAR)
    assert plain.velocity.tobytes() == wrapped.velocity.tobytes()


def test_distances_are_those_to_the_rectangle() -> None:
    turned = Vehicles.create(10.0, 0.0, np.pi / 2, 0.0, front=2.0, rear=3.0, width=2.0)
    points = np.array([[10.0, 5.0], [10.0, -4.0], [12.5, 0.0], [13.0, 4.0], [10.0, 0.0]])
    told = distance_to_next(points, turned)
    assert told == pytest.approx([3.0, 1.0, 1.5, np.hypot(2.0, 2.0), 0.0])


# --- cohesion ---------------------------------------------------------------------------------


def test_attraction_is_zero_within_the_threshold_then_the_papers() -> None:
    pair = np.array([[0.0, 0.0], [0.9, 0.0], [50.0, 50.0]])
    groups = np.array([4, 4, -1])
    assert not attraction(pair, groups).any()  # 0.45 m from the middle: the threshold is 0.5 m
    pair[1, 0] = 2.0  # 0.5 m beyond the threshold
    assert attraction(pair, groups) == pytest.approx(np.array([[1.5, 0], [-1.5, 0], [0, 0]]))
    pair[1, 0] = 9.0
    assert attraction(pair, groups) == pytest.approx(np.array([[3.0, 0], [-3.0, 0], [0, 0]]))


def apart(model, groups, seconds: float = 6.0) -> float:
    """How far apart two are at the end who began 5 m apart and walk the same way."""
    crowd = Crowd.create([(0, 0), (5, 0)], [(0, 1.3)] * 2, 1.3, [[(0, 90)], [(5, 90)]])
    moved = Cohesive(model, lambda: np.array(groups))
    for _ in range(round(seconds / STEP)):
        moved.advance(crowd, Vehicles.empty())
    speed = np.hypot(*crowd.velocity.T)
    assert speed.max() <= SIM.max_speed + 1e-9
    return float(np.hypot(*(crowd.position[1] - crowd.position[0])))


@pytest.mark.parametrize("model", [CrowdModel(SIM, STEP), PlainModel("social-force", SIM, STEP)])
def test_who_belongs_together_walks_together_and_others_do_not(model) -> None:
    assert apart(model, [-1, -1]) == pytest.approx(5.0, abs=0.3)
    assert 0.6 < apart(model, [0, 0]) < 2.5


def test_models_have_what_their_people_need_and_nothing_else() -> None:
    def of(**crowd) -> list[str]:
        config = RunConfig.model_validate({"crowd": crowd})
        model, names = model_of(config, STEP, Roster()), []
        while True:
            names.append(type(model).__name__)
            if not isinstance(model, Inattentive | Cohesive):
                return names
            model = model._model

    assert of() == ["CrowdModel"]
    assert of(people={"elderly": 1.0}) == ["CrowdModel"]
    assert of(groups=0.5) == ["Cohesive", "CrowdModel"]
    assert of(groups=0.5, model="orca") == ["PlainModel"]
    assert of(people={"distracted": 0.1}, model="orca") == ["Inattentive", "PlainModel"]
    flow = {"from": [0, 0, 1, 1], "to": [5, 5], "rate": 1.0, "groups": 0.5}
    assert of(flow=[{**flow, "people": {"distracted": 1.0}}]) == [
        "Cohesive",
        "Inattentive",
        "CrowdModel",
    ]


def test_the_roster_knows_distracted_people_and_groups() -> None:
    crowd = Crowd.create([(0, 0), (1, 0), (2, 0)], [(0, 0)] * 3, 1.0, [[(9, 9)]] * 3)
    traits = {"a": Trait("distracted", "a"), "b": Trait("adult", "a")}
    roster = Roster(["a", "b", "c"], crowd, traits)
    assert roster.distracted.tolist() == [True, False, False]
    assert roster.groups.tolist() == [0, 0, -1]
    roster.release(np.array([True, False, False]))
    late = Crowd.create([(5, 5)], [(0, 0)], 1.0, [[(9, 9)]])
    roster.add(["d"], late, {"d": Trait("distracted")})
    assert roster.distracted.tolist() == [False, False, True]
    assert roster.groups.tolist() == [0, -1, -1]
