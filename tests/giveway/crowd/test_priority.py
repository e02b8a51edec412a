"""Who on foot has priority: a zebra 4 m wide and 7 m long at x = 22 m, its kerbs at y = +-3.5 m."""

import numpy as np
import pytest

from giveway.crowd.priority import PriorityOnFoot
from giveway.sumo.network.pedestrian_crossings import Crossing
from pedestrian_model import Crowd

KERB = 3.5


def zebra(x=22.0, y=0.0, *, zebra=True, system="", link=-1):
    ends = np.array([[x, y + KERB], [x, y - KERB]])
    return Crossing(f":j{x}_c0_0", ends, 4.0, zebra, system, link)


def walker(y, x=22.0, to=(22.0, 10.0), **route):
    return Crowd.create([[x, y]], [[0.0, 1.4]], 1.4, [[to]], **route)


def priority_of(crowd, *crossings, light=""):
    asked = []

    def state(system):
        asked.append(system)
        return light

    PriorityOnFoot(crossings or [zebra()], state).update(crowd)
    assert len(asked) == len(set(asked)), "each light is asked once"
    return crowd.priority[0]


@pytest.mark.parametrize(
    ("somebody", "priority"),
    [
        (walker(0.0), 1.0),  # on it
        (walker(-3.4), 1.0),
        (walker(-4.5), 1.0),  # at the kerb, on the way across
        (walker(4.5, to=(22.0, -9.0)), 1.0),  # from the other side
        (walker(-5.1), 0.0),  # a step away from the kerb yet
        (walker(-4.5, to=(22.0, -20.0)), 0.0),  # has left it
        (walker(-4.2, x=21.0, to=(40.0, -4.4)), 0.0),  # walks past along the kerb
        (walker(0.0, x=24.4), 1.0),  # beside the marking
        (walker(0.0, x=25.0), 0.0),  # crosses elsewhere
        (walker(0.0, x=400.0), 0.0),
    ],
)
def test_on_a_zebra_and_about_to_enter_it(somebody, priority):
    assert priority_of(somebody) == priority


@pytest.mark.parametrize("far", [0.0, 0.25, 0.5, 1.0])
def test_it_fades_over_the_first_metre_behind(far):
    assert priority_of(walker(KERB + far)) == pytest.approx(1.0 - far)


@pytest.mark.parametrize(
    ("light", "at_the_kerb", "on_it"),
    [("G", 1.0, 1.0), ("g", 1.0, 1.0), ("r", 0.0, 1.0), ("y", 0.0, 1.0), ("O", 1.0, 1.0)],
)
def test_a_light_decides_who_may_enter_and_people_on_it_finish(light, at_the_kerb, on_it):
    governed = zebra(system="tls", link=1)
    assert priority_of(walker(-4.0), governed, light=f"r{light}") == at_the_kerb
    assert priority_of(walker(-2.0), governed, light=f"r{light}") == on_it


def test_where_people_have_to_wait_for_a_gap_nobody_has_priority():
    gap = zebra(zebra=False)
    assert priority_of(walker(0.0), gap) == 0.0
    assert len(PriorityOnFoot([gap], str)) == 0


@pytest.mark.parametrize(("light", "priority"), [("r", 0.0), ("G", 1.0)])
def test_waiting_for_green_a_step_from_the_kerb_is_not_crossing(light, priority):
    """A crowd at the kerb pushes its first onto the crossing; they wait all the same."""
    waiting = Crowd.create(
        [[22.0, -3.3]],
        [[0.0, 0.0]],
        1.4,
        [[(22.0, -3.9), (22.0, 3.9)]],
        passages=[[(0.0, 1.0, 2.0), (0.0, 1.0, 2.0)]],
        signals=[[0, -1]],
    )
    governed = zebra(system="tls", link=0)
    assert priority_of(waiting, governed, light=light) == priority


def test_off_the_middle_people_head_for_the_nearest_line_point():
    """A way-point in the middle of the zebra's kerb, 2 m aside, is a line across the way."""
    aside = walker(-3.9, x=23.8, to=(22.0, -3.2), passages=[[(0.0, 1.0, 2.0)]])
    assert priority_of(aside) == 1.0


def test_among_many_crossings_everybody_finds_the_own_one():
    """As without a grid: crossings 20 m apart over two kilometres, people anywhere."""
    random = np.random.default_rng(3)
    crossings = [zebra(x, y) for x in np.arange(0.0, 2000.0, 20.0) for y in (0.0, 30.0, 900.0)]
    n = 3000
    position = np.column_stack([random.uniform(-30.0, 2030.0, n), random.uniform(-8.0, 40.0, n)])
    goal = position + random.normal(0.0, 20.0, (n, 2))
    crowd = Crowd.create(position, np.zeros((n, 2)), 1.4, list(goal[:, None]))
    PriorityOnFoot(crossings, str).update(crowd)
    found = crowd.priority.copy()
    alone = np.zeros(n)
    for crossing in crossings:
        PriorityOnFoot([crossing], str).update(crowd)
        alone = np.maximum(alone, crowd.priority)
    np.testing.assert_array_equal(found, alone)
    assert (found > 0.0).sum() > 100


def test_what_was_is_forgotten():
    somebody = walker(0.0)
    somebody.priority[:] = 1.0
    PriorityOnFoot([zebra(x=500.0)], str).update(somebody)
    assert somebody.priority[0] == 0.0
    PriorityOnFoot([], str).update(Crowd.empty())
