"""What is noted of an ego's way: a lane along x, a crossing over it and one far away."""

import numpy as np
import pytest

from giveway.cosimulation.law_records import LawfulPlaces, LawRecords, way_of
from giveway.crowd.roster import Roster
from giveway.ego.rules.route import Stop
from giveway.geometry.path import EgoPath
from giveway.journal.recorder import Recorder
from giveway.run_data.way import EgoWay, Halt, JunctionOnWay, LimitOnWay, StopLine
from giveway.sumo.network.lane_path import Light
from giveway.sumo.network.pedestrian_crossings import Crossing
from pedestrian_model import Crowd

PATH = EgoPath.through([(0.0, 0.0), (60.0, 0.0)])


def crossing(name, x, y=0.0):
    ends = np.array([[x, y + 3.5], [x, y - 3.5]])
    return Crossing(name, ends, 4.0, True, "tls", 2)


def test_what_lies_behind_the_ego_as_it_departs_is_left_out():
    for departure, count in ((24.0, 1), (30.0, 0)):
        places = LawfulPlaces([crossing("a", 20.0)], [])
        way = way_of("ego", PATH, departure, 5.0, places)
        assert len(way.crossings) == count


def test_all_places_on_the_way_are_noted_in_its_order():
    way = way_of(
        "ego",
        PATH,
        5.0,
        5.0,
        LawfulPlaces(
            crossings=[crossing("b", 40.0), crossing("a", 20.0), crossing("c", 20.0, y=30.0)],
            lights=[Light(17.0, "tls", 1)],
            junctions=[JunctionOnWay(18.0, 30.0, (25.0,), stop_sign=True)],
            stops=[Stop(48.0, 50.0, 10.0, -np.inf)],
        ),
    )
    assert [place.lane for place in way.crossings] == ["a", "b"]
    assert way.crossings[0].ends == ((20.0, 3.5), (20.0, -3.5))
    assert (way.crossings[0].zebra, way.crossings[0].system, way.crossings[0].link) == (
        True,
        "tls",
        2,
    )
    assert way.lines == (StopLine(17.0, "tls", 1),)
    assert way.junctions == (JunctionOnWay(18.0, 30.0, (25.0,), stop_sign=True),)
    assert way.halts == (Halt(48.0, 50.0),)
    assert way.points == ((0.0, 0.0), (60.0, 0.0))


class Lights:
    """Stands in for the session: only the state of a light is asked of it."""

    def __init__(self):
        self.state = "rG"
        self.asked = 0

    def light_state(self, system):
        assert system == "tls"
        self.asked += 1
        return self.state


@pytest.fixture
def records():
    lights, recorder = Lights(), Recorder()
    return lights, recorder, LawRecords(lights, recorder)


RULED = EgoWay("ego", ((0.0, 0.0), (9.0, 0.0)), lines=(StopLine(5.0, "tls", 1),))


def test_only_the_changes_of_a_light_are_kept(records):
    lights, recorder, law = records
    law.depart(RULED)
    for time, state in ((0.0, "rG"), (0.1, "rG"), (0.2, "Gr"), (0.3, "Gr")):
        lights.state = state
        law.signals(time)
    track = recorder.rows().signal_track()
    assert (track.time.tolist(), track.state.tolist()) == ([0.0, 0.2], ["rG", "Gr"])


def test_everybody_is_noted_once_for_each_time_that_they_join(records):
    _, recorder, law = records
    law.depart(RULED)
    recorder.instant(0.0)
    ways = [[(1, 1)], [(6, 6), (7, 7)]]
    crowd = Crowd.create([[0, 0], [5, 5]], np.zeros((2, 2)), [1.1, 1.3], ways)
    roster = Roster()
    roster.take_in(["a", "b"], crowd)
    law.walks(roster)
    law.walks(roster)
    recorder.instant(0.05)
    roster.release(np.array([True, False]))
    roster.take_in(["a"], crowd.select(np.array([True, False])))
    law.walks(roster)
    people = recorder.rows().people_track()
    assert people.step.tolist() == [0, 0, 0, 0, 0, 1, 1]
    assert people.pedestrian.tolist() == [0, 0, 1, 1, 1, 0, 0]
    assert people.x.tolist() == [0.0, 1.0, 5.0, 6.0, 7.0, 0.0, 1.0]
    assert people.desired_speed.tolist() == [1.1, 1.1, 1.3, 1.3, 1.3, 1.1, 1.1]


def test_where_the_law_has_no_say_only_the_path_is_kept(records):
    lights, recorder, law = records
    way = EgoWay("ego", ((0.0, 0.0), (9.0, 0.0)), limits=(LimitOnWay(0.0, 13.9),))
    law.depart(way)
    law.signals(0.0)
    recorder.instant(0.0)
    law.walks(Roster(["a"], Crowd.create([[0, 0]], [[0, 0]], 1.0, [[(1, 1)]])))
    rows = recorder.rows()
    assert (rows.ways(), lights.asked) == ({"ego": way}, 0)
    assert len(rows.people_track().step) == 0
