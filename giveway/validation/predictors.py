"""The predictors: the model, with and without the vehicle's force, and two baselines."""

from dataclasses import replace
from typing import Protocol

import numpy as np

from giveway.geometry.kernel import Array
from giveway.validation.protocol import Window
from pedestrian_model import Crowd, Predictor, VciParameters

VCI = "VCI"
CV = "CV"
GOAL_CV = "goalCV"
NO_VEHICLE = "VCI without f_v"
OWN_PACE = "VCI at own pace"
NAMES = (VCI, OWN_PACE, NO_VEHICLE, CV, GOAL_CV)

SLOWEST_PACE = 0.3  # Desired speed [m/s] of a pedestrian who stands at the start (own choice)


class TrackPredictor(Protocol):
    """Predicts the tracks in a window."""

    def __call__(self, window: Window) -> Array:
        """Return the positions (H, n, 2) [m] at 1 ... H frames ahead."""


def predictors(
    parameters: VciParameters, time_step: float, frames: int
) -> dict[str, TrackPredictor]:
    """Return all predictors of ``NAMES``, for windows of ``frames`` of ``time_step`` [s]."""
    without = replace(parameters, vehicle_strength=0.0)
    return {
        VCI: VciPredictor(parameters, time_step, frames),
        OWN_PACE: VciPredictor(parameters, time_step, frames, own_pace=True),
        NO_VEHICLE: VciPredictor(without, time_step, frames),
        CV: lambda window: straight_on(window.position, window.velocity, time_step, frames),
        GOAL_CV: lambda window: straight_to(
            window.position, window.velocity, window.destination, time_step, frames
        ),
    }


class VciPredictor:
    """The pedestrian model: all pedestrians jointly, with the vehicles as they drove.

    Args:
        parameters: Parameters of the model.
        time_step: Time step from frame to frame [s].
        frames: Number H of frames of a window.
        own_pace: True if each pedestrian's desired speed is the present speed, not the parameters'.
            In a run it is known for each pedestrian, too.
    """

    def __init__(
        self,
        parameters: VciParameters,
        time_step: float,
        frames: int,
        *,
        own_pace: bool = False,
    ) -> None:
        self._own_pace = own_pace
        self._desired_speed = parameters.desired_speed
        self._predictor = Predictor(parameters, time_step, frames)

    def __call__(self, window: Window) -> Array:
        """Return positions (H, n, 2) [m] at 1 ... H frames ahead, overwritten by the next call."""
        desired: Array | float = self._desired_speed
        if self._own_pace:
            speed = np.hypot(window.velocity[:, 0], window.velocity[:, 1])
            desired = np.maximum(speed, SLOWEST_PACE)
        crowd = crowd_of(window.position, window.velocity, window.destination, desired)
        return self._predictor.predict(crowd, window.vehicles)


def crowd_of(
    position: Array, velocity: Array, destination: Array, desired_speed: Array | float
) -> Crowd:
    """Return a crowd in which every pedestrian walks straight to the destination."""
    return Crowd.create(position, velocity, desired_speed, list(destination[:, None, :]))


def straight_on(position: Array, velocity: Array, time_step: float, frames: int) -> Array:
    """Return positions (H, n, 2) [m] at constant velocity."""
    time = time_step * np.arange(1, frames + 1)
    return position + time[:, None, None] * velocity


def straight_to(
    position: Array, velocity: Array, destination: Array, time_step: float, frames: int
) -> Array:
    """Return positions (H, n, 2) [m] at the present speed straight to the destination."""
    course = destination - position
    length = np.hypot(course[:, 0], course[:, 1])
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    walked = np.minimum(time_step * np.arange(1, frames + 1)[:, None] * speed, length)
    direction = course / np.where(length > 0.0, length, 1.0)[:, None]
    out: Array = position + walked[:, :, None] * direction
    return out
