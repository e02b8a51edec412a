"""At the zebra behind the bundled junction: who is in the ego's way when it drives onto it?"""

import giveway

ZEBRA = (58.0, 62.0)  # [m] from where to where along the road (x)
WAY = (-1.75 - 1.3, -1.75 + 1.3)  # [m] the body's way over it (y), and a body's radius


def in_the_way(priority):
    """Those on the zebra, in the way, when the ego's front comes onto it; whether it has waited."""
    run = {
        "scenario": "junction",
        "regulation": {"priority": priority},
        "ego": {"depart_time": 51.0, "depart_position": 10.0, "travel_distance": 55.0},
    }
    run["ego"]["route"] = ["east_out", "far_east_out"]  # from behind the junction on
    result = giveway.run(run)
    ego = result.ego
    onto = ego.time[ego.x >= ZEBRA[0]].iloc[0]
    everybody = result.trajectories
    now = everybody[(everybody.time - onto).abs() < 1e-6]
    people = now[now.type == "pedestrian"]
    there = people[people.x.between(*ZEBRA) & people.y.between(*WAY)]
    return list(there.id), (ego.waits_for == "yield").any()


def test_it_waits_until_its_way_over_the_zebra_is_free():
    nobody, waited = in_the_way("road")
    assert nobody == []
    assert waited


def test_without_the_law_of_the_road_somebody_is_there():
    somebody, waited = in_the_way("none")
    assert somebody
    assert not waited
