"""An ego with its real FMU and controller before a traffic light, at any moment of its cycle."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Literal

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.config import EgoRunConfig
from giveway.ego.controllers import make_controller
from giveway.ego.ego import Course, Ego
from giveway.ego.perception.truth import Truth
from giveway.ego.preparation import make_waiting_ego
from giveway.ego.rules.protocol import Told
from giveway.ego.rules.rule_set import RuleSet
from giveway.ego.rules.traffic_lights import TrafficLights
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import Light
from pedestrian_model import OPEN_GROUND, Crowd

STEP = 0.05  # [s]
YELLOW, RED = 3.0, 20.0  # [s]
DEPARTURE = 50.0  # [m]
CREEPING = 0.02  # [m/s]
HALTED = 2.0  # [s] slower than that for so long is a stop
TOO_LATE = 2.0  # [s] of red in which who cannot stop passes


def drive(
    config: EgoRunConfig, line: float, yellow_at: float, every: int
) -> list[tuple[float, float, str]]:
    """Front [m], speed [m/s] and colour at each step until the red is over.

    Args:
        config: the ego's.
        line: station of the stop line [m].
        yellow_at: when the green ends [s].
        every: how many steps apart the light is looked at: SUMO's own step.
    """
    shape, nobody = VehicleShape(), Crowd.empty()
    path = EgoPath.through([(0.0, 0.0), (2000.0, 0.0)])
    rows = []
    with ExitStack() as stack:
        waiting = make_waiting_ego(config, make_controller(config, STEP), STEP, stack)
        waiting.start(config.ego.initial_speed or 0.0)
        lights = TrafficLights([Light(line, "tls", 0)], comfortable=2.0, hardest=8.0)
        ego = Ego(waiting, Course(path, DEPARTURE, 1900.0), shape, RuleSet([lights]), STEP)
        poses = np.zeros((waiting.horizon, 1, 7))
        poses[:, :, 4:] = shape.length / 2, shape.length / 2, shape.width
        for k in range(round((yellow_at + YELLOW + RED) / STEP)):
            time = k * STEP
            colour = "G" if time < yellow_at else "y" if time < yellow_at + YELLOW else "r"
            if k % every == 0:
                ego.update(time, Told({"tls": colour}))
            rows.append((ego.front, ego.vehicle.speed, colour))
            ego.corridor.fill_poses(poses, 0, ego.front, ego.vehicle.speed)
            ego.decide(
                k, time, ego.look(0, poses, Truth.of_people(nobody), OPEN_GROUND, np.arange(0))
            )
            ego.advance()
    return rows


@given(
    controller=st.sampled_from(["mpc", "mpc-paper", "pid-paper", "pid-tuned"]),
    speed=st.floats(3.0, 16.0),
    share=st.floats(0.0, 1.0),
    distance=st.floats(0.3, 120.0),
    yellow_at=st.floats(0.0, 15.0),
    every=st.sampled_from([1, 20]),
    gap_from=st.sampled_from(["bumper", "centre"]),
    safe_distance=st.sampled_from([2.0, 8.0, 15.0]),
)
@settings(max_examples=40)
def test_an_ego_stops_before_the_line_or_passes_it(
    controller: str,
    speed: float,
    share: float,
    distance: float,
    yellow_at: float,
    every: int,
    gap_from: Literal["bumper", "centre"],
    safe_distance: float,
) -> None:
    config = EgoRunConfig.model_validate(
        {
            "controller": controller,
            "controller_options": {"gap_from": gap_from} if "paper" in controller else {},
            "ego": {"initial_speed": speed * share},
            "regulation": {
                "reference_speed": speed,
                "safe_distance": safe_distance,
            },
        }
    )
    line = DEPARTURE + distance
    rows = drive(config, line, yellow_at, every)
    slow = 0
    for front, now, colour in rows:
        slow = slow + 1 if colour == "r" and now < CREEPING else 0
        if slow * STEP >= HALTED:
            assert front <= line
    at_red = [front <= line for front, _, colour in rows if colour == "r"]
    settled = at_red[every + round(TOO_LATE / STEP) :]
    assert settled == [settled[0]] * len(settled)  # nobody crosses the line any more
