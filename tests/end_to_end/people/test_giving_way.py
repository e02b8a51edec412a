"""At the bundled junction: who is in the ego's way when it drives onto a crossing?

On the zebra behind the signals, and on the southern arm, into which the ego turns on green while
people cross it on theirs.
"""

from support.priority import rules_of

import giveway

RASH = {"precaution_weight": 0.0}  # an ego that gives way for the law's sake alone
SLOWLY = 4.0  # [m/s] so that both drives come when people are there
# People who come before cars that do not let them pass, and who are expected to
BOLD = {"crowd": {"preset": "SIM"}, "perception": {"preset": "SIM"}}
ZEBRA = (58.0, 62.0)  # [m] from where to where along the road (x)
WAY = (-1.75 - 1.3, -1.75 + 1.3)  # [m] the body's way over it (y), and a body's radius


def in_the_way(priority):
    """When the ego's front comes onto the zebra, and who is in its way there then."""
    run = {
        "scenario": "junction",
        "seed": 8,
        **BOLD,
        "controller_options": RASH,
        "regulation": {"reference_speed": SLOWLY},
        "rules": rules_of(priority),
        "ego": {"depart_time": 114.0, "depart_position": 10.0, "travel_distance": 55.0},
    }
    run["ego"]["route"] = ["east_out", "far_east_out"]  # from behind the junction on
    result = giveway.run(run)
    ego = result.ego
    onto = ego.time[ego.x >= ZEBRA[0]].iloc[0]
    everybody = result.trajectories
    now = everybody[(everybody.time - onto).abs() < 1e-6]
    people = now[now.type == "pedestrian"]
    there = people[people.x.between(*ZEBRA) & people.y.between(*WAY)]
    return onto, list(there.id)


def test_at_the_zebra_it_lets_people_go_first():
    lawful, nobody = in_the_way("road")
    lawless, somebody = in_the_way("none")
    assert nobody == []
    assert somebody
    assert lawful > lawless + 1.0  # [s]


ARM = (-8.0 - 0.3, -4.0 + 0.3)  # [m] the southern crossing, from where to where across it (y)
TURN = (-1.75 - 2.3, -1.75 + 2.3)  # [m] the body's way over it (x), and a body's radius


def turning(priority):
    """When the ego's front comes onto the southern crossing, and who is in its way there then."""
    ego = {"route": ["west_in", "south_out"], "depart_time": 82.0, "depart_position": 70.0}
    regulation = {"reference_speed": SLOWLY}
    rules = rules_of(priority) | {"signal_plans": False}  # it stands before the red light
    run = {"scenario": "junction", "seed": 26, "regulation": regulation, "rules": rules}
    result = giveway.run(
        run | BOLD | {"controller_options": RASH, "ego": ego | {"travel_distance": 70.0}}
    )
    ego = result.ego
    onto = ego.time[ego.y <= ARM[1]].iloc[0]
    everybody = result.trajectories
    people = everybody[(everybody.type == "pedestrian") & ((everybody.time - onto).abs() < 1e-6)]
    return onto, list(people[people.x.between(*TURN) & people.y.between(*ARM)].id)


def test_it_turns_behind_those_who_cross_on_their_green():
    lawful, nobody = turning("road")
    lawless, somebody = turning("none")
    assert nobody == []
    assert somebody
    assert 90.0 < lawless < lawful < 117.0  # [s] on the same green: it begins at 90 s
    assert lawful > lawless + 2.0
