"""JuPedSim's people: its own, where there is neither wall nor vehicle, and sound where there is."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.plug_ins.conformance import check_model
from giveway.plug_ins.plugged_in_model import PluggedInModel
from pedestrian_model import (
    JUPEDSIM_MODELS,
    SIM,
    Crowd,
    JuPedSimPeople,
    ModelSetup,
    Surroundings,
    Vehicles,
    Walls,
)

jupedsim = pytest.importorskip("jupedsim")
DT = 0.05
SETUP = ModelSetup(DT, SIM.body_radius, SIM.max_acceleration, SIM.max_speed, 1)
SPEEDS, FORCES = JUPEDSIM_MODELS


def hosted(name):
    return PluggedInModel(name, lambda: JuPedSimPeople(name, SETUP), SETUP, SIM)


def walk(name, crowd, seconds, vehicles=lambda t: Vehicles.empty(), surroundings=None):
    """(steps + 1, n, 2) [m] where everybody was."""
    model, places = hosted(name), [crowd.position.copy()]
    for k in range(round(seconds / DT)):
        model.advance(crowd, vehicles(k * DT), surroundings or Surroundings())
        places.append(crowd.position.copy())
    return np.array(places)


def people(places, goals, speed=1.3, moving=True):
    places, goals = np.atleast_2d(places).astype(float), np.atleast_2d(goals).astype(float)
    way = goals - places
    v = speed * way / np.hypot(*way.T)[:, None] * moving
    return Crowd.create(places, v, speed, [goal[None] for goal in goals])


@pytest.mark.parametrize("name", JUPEDSIM_MODELS)
def test_the_conformance_kit_finds_nothing(name):
    findings = check_model(lambda setup: JuPedSimPeople(name, setup), SETUP)
    assert len(findings) == 12
    assert [f for f in findings if f.problem and f.rule != "is quick"] == []


def theirs(kind, crowd, seconds, dt):
    """(n, 2) [m] where JuPedSim has them when it is left alone for the whole time."""
    simulation = jupedsim.Simulation(
        model=getattr(jupedsim, kind)(),
        geometry=[(-30.0, -30.0), (30.0, -30.0), (30.0, 30.0), (-30.0, 30.0)],
        dt=dt,
    )
    stage = simulation.add_direct_steering_stage()
    journey = simulation.add_journey(jupedsim.JourneyDescription([stage]))
    ids = []
    for i in range(len(crowd)):
        own = {"velocity": tuple(crowd.velocity[i])} if kind == "SocialForceModel" else {}
        agent = getattr(jupedsim, f"{kind}AgentParameters")(
            position=tuple(crowd.position[i]),
            desired_speed=float(crowd.desired_speed[i]),
            radius=SIM.body_radius,
            journey_id=journey,
            stage_id=stage,
            **own,
        )
        ids.append(simulation.add_agent(agent))
        simulation.agent(ids[-1]).target = tuple(crowd.waypoints[i])
    simulation.iterate(round(seconds / dt))
    return np.array([simulation.agent(i).position for i in ids])


def compared(name, dt):
    """[m] (3,) how far people who meet are from where JuPedSim has them, and from straight on."""
    crowd = people([(-4.0, 0.4), (4.0, -0.4), (0.0, 4.0)], [(9.0, 0.4), (-9.0, -0.4), (0.3, -9.0)])
    left_alone = theirs(name.partition(":")[2], crowd, 4.0, dt)
    straight = crowd.position + 4.0 * crowd.velocity
    walk(name, crowd, 4.0)
    return np.hypot(*(crowd.position - left_alone).T), np.hypot(*(left_alone - straight).T)


@pytest.mark.parametrize(("name", "dt"), [(SPEEDS, DT), (FORCES, 0.01)])
def test_people_built_anew_each_step_walk_as_those_kept(name, dt):
    """Speeds of the first differ as bodies do: nobody changes by more than 5 m/s^2."""
    off, aside = compared(name, dt)
    assert aside.max() > 0.7
    assert off.max() < 0.06


@pytest.mark.parametrize("kind", ["AnticipationVelocityModel", "CollisionFreeSpeedModelV3"])
def test_models_that_remember_a_direction_would_not(kind):
    """Why they are not among those that are offered."""
    off, aside = compared(f"jupedsim:{kind}", DT)
    assert off.max() > 0.5 * aside.max()


@pytest.mark.parametrize("name", JUPEDSIM_MODELS)
def test_they_stop_before_a_close_car_and_go_on_behind_it(name):
    crowd = people((0.0, -5.0), (0.0, 8.0))
    places = walk(name, crowd, 14.0, lambda t: Vehicles.create(-18.5 + 3.0 * t, 0.0, 0.0, 3.0))
    passed = round((18.5 + 2.5) / 3.0 / DT)
    assert places[passed, 0, 1] < -1.0 - SIM.body_radius
    assert places[-1, 0, 1] > 2.0


@pytest.mark.parametrize("name", JUPEDSIM_MODELS)
def test_nobody_walks_through_a_standing_car_or_a_wall(name):
    crowd = people([(-6.0, 0.3), (-6.0, 4.0)], [(9.0, 0.3), (-6.0, 9.0)])
    wall = Surroundings(Walls.create([[9.0, 6.0, -20.0, 6.0]]))
    wall = wall if wall.walls.nearest(np.array([[-6.0, 4.0]]))[1][0, 1] < 0.0 else None
    assert wall is not None, "people walk on the wall's left"
    places = walk(name, crowd, 8.0, lambda t: Vehicles.create(0.0, 0.0, 0.0, 0.0), wall)
    inside = (np.abs(places[..., 0]) < 2.4) & (np.abs(places[..., 1]) < 0.9)
    assert not inside.any()
    assert places[:, 1, 1].max() < 6.0


def test_a_far_vehicle_too_fast_for_jupedsim_changes_nothing():
    cars = Vehicles.create([300.0, 8.0], [0.0, 14.0], [0.0, 0.0], [30.0, 25.0])
    alone, beside = people((0.0, 0.0), (9.0, 0.0)), people((0.0, 0.0), (9.0, 0.0))
    for name in JUPEDSIM_MODELS:
        walk(name, alone, 1.0)
        walk(name, beside, 1.0, lambda t: cars)
        np.testing.assert_array_equal(alone.position, beside.position)
