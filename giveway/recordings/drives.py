"""One recorded vehicle and the people around it, as the metrics of a run take them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.metrics.close_passes import Clearances, clearances
from giveway.metrics.conflicts import proximity
from giveway.metrics.encroachment import Encroachment, encroachment
from giveway.recordings.recording import Recording
from giveway.run_data.tracks import CrowdTrack, EgoTrack
from pedestrian_model import SIM

MOVING = 1.0
"""Speed [m/s] that a vehicle reaches if it is not parked."""
RADIUS = SIM.body_radius
"""Radius [m] of a person's circle."""
_AROUND = 2.0  # Time [s] before and after a drive in which people at its places count
_COLUMNS = ("gap", "vehicle_gap", "stop_gap", "force", "reference_speed", "solver_iterations")
_TEXTS = ("controller", "reason", "solver_status", "waits_for")


class Drive(NamedTuple):
    """One recorded vehicle.

    Attributes:
        recording: Recording in which it is.
        number: Index of the vehicle in the recording.
        first: Instant of the recording at which it is seen first.
        track: Track of the vehicle, T instants; where it is not seen, it is interpolated.
        shape: Rectangle of the vehicle.
    """

    recording: Recording
    number: int
    first: int
    track: EgoTrack
    shape: VehicleShape

    @property
    def id(self) -> str:
        """The id of the vehicle."""
        return self.recording.vehicles.ids[self.number]


class Nearness(NamedTuple):
    """The people of a recording while one vehicle is seen; R rows of people.

    Attributes:
        person: Index (R,) of each row's person.
        speed: Speed (R,) [m/s] of the vehicle.
        clearance: Distance (R,) [m] from outline to outline; negative where they overlap.
        time_to_collision: Time (R,) [s] to the first contact at present velocities.
    """

    person: NDArray[np.int64]
    speed: Array
    clearance: Array
    time_to_collision: Array

    def smallest(self, values: Array, people: int) -> Array:
        """Return the smallest value (n,) of each person, infinite without a row."""
        smallest = np.full(people, np.inf)
        np.minimum.at(smallest, self.person, values)
        return smallest

    def clearances(self, people: int) -> Clearances:
        """Return the smallest clearances of each person (n,), by the vehicle's speed."""
        return clearances(self.person, self.speed, self.clearance, people)


def drive_of(recording: Recording, number: int) -> Drive:
    """Return one vehicle of a recording as a drive.

    Args:
        recording: Recording.
        number: Index of the vehicle.
    """
    vehicles = recording.vehicles
    rows = vehicles.rows(number)
    frame = vehicles.frame[rows]
    every = np.arange(frame[0], frame[-1] + 1)

    def filled(values: Array) -> Array:
        return np.interp(every, frame, values)

    time = every / recording.frame_rate
    heading = filled(np.unwrap(vehicles.heading[rows]))
    speed = filled(np.abs(vehicles.speed[rows]))
    x, y = filled(vehicles.position[rows, 0]), filled(vehicles.position[rows, 1])
    front, rear, width = vehicles.body[number].tolist()
    position = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    empty = {name: np.zeros(len(every)) for name in _COLUMNS}
    texts = {name: np.full(len(every), "") for name in _TEXTS}
    track = EgoTrack(
        **empty | texts,
        time=time,
        position=position,
        front_x=x + front * np.cos(heading),
        front_y=y + front * np.sin(heading),
        heading=heading,
        speed=speed,
        acceleration=np.gradient(speed, time) if len(every) > 1 else np.zeros(1),
    )
    return Drive(recording, number, int(frame[0]), track, VehicleShape(front + rear, width))


def nearness(drive: Drive) -> Nearness:
    """Return how near people and vehicle are at each instant at which both are seen."""
    seen = _people_between(drive, 0, drive.track.time.size - 1)
    crowd = _crowd(drive, seen)
    found = proximity(drive.track, crowd, drive.shape, RADIUS)
    speed = drive.track.speed[crowd.step]
    return Nearness(crowd.pedestrian, speed, found.clearance, found.time_to_collision)


def encroachments(drive: Drive, near: NDArray[np.bool_]) -> Encroachment:
    """Return the post-encroachment times with the people that a mask (n,) names.

    People count who are at a place of the vehicle up to two seconds before it is seen first or
    after it is seen last.
    """
    count = round(_AROUND * drive.recording.frame_rate)
    instants = drive.track.time.size
    rows = _people_between(drive, 0, instants - 1 + count)
    rows &= near[drive.recording.people.track]
    clock = (drive.first + np.arange(instants + count)) / drive.recording.frame_rate
    return encroachment(drive.track, _crowd(drive, rows), drive.shape, RADIUS, clock)


def _people_between(drive: Drive, first: int, last: int) -> NDArray[np.bool_]:
    """Return the rows of people between two instants of the drive, both included."""
    step = drive.recording.people.frame - drive.first
    return (step >= first) & (step <= last)


def _crowd(drive: Drive, rows: NDArray[np.bool_]) -> CrowdTrack:
    people = drive.recording.people
    return CrowdTrack(
        step=people.frame[rows] - drive.first,
        pedestrian=people.track[rows],
        x=people.position[rows, 0],
        y=people.position[rows, 1],
        vx=people.velocity[rows, 0],
        vy=people.velocity[rows, 1],
        ids=people.ids,
    )
