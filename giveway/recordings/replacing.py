"""A scenario in which an ego drives in place of a recorded vehicle."""

import numpy as np
import pandas as pd
import tomlkit

from giveway.errors import ConfigError, DatasetError, suggestion
from giveway.geometry.kernel import Array
from giveway.recordings.describing import parked
from giveway.recordings.recording import Recording
from giveway.scenario_files.configuration_text import configuration_of
from giveway.scenario_files.path_network import DRIVE, GATE, network_along

_SMOOTHED = 0.5  # Time [s] over which the places of the vehicle are averaged
_APART = 2.0  # Distance [m] between the points of its path
_BEHIND = 1.0  # Length [m] of the lane behind the vehicle's rear at the beginning
_BEYOND = 30.0  # Length [m] of the lane beyond the vehicle's last place
_WALK_ON = 20.0  # Distance [m] that people go on after the end of the recording
_PATIENCE = 60.0  # Time [s] that the ego may take longer than the vehicle


def scenario_for(
    recording: Recording, vehicle: str | None, name: str, dataset: str
) -> dict[str, str]:
    """Return the files of a scenario, by their names: network, SUMO's configuration, settings.

    The ego begins where, when and as fast as the vehicle, and drives its path, up to its highest
    speed. Other recorded vehicles are left out.

    Args:
        recording: Recording.
        vehicle: Id of the vehicle.
        name: Name of the scenario.
        dataset: Name of the data set, or path of its description.

    Raises:
        ConfigError: the vehicle is not named, or not in the recording.
        DatasetError: it does not drive.
    """
    number = _number(recording, vehicle)
    tracks = recording.vehicles
    rows = tracks.rows(number)
    path = _path(tracks.position[rows], recording.frame_rate)
    if len(path) < 2:
        raise DatasetError(
            f"--vehicle {vehicle}: goes less than {_APART:g} m in '{recording.name}'; expected a "
            "vehicle that drives"
        )
    front, rear, width = tracks.body[number].tolist()
    first, last = _unit(path[1] - path[0]), _unit(path[-1] - path[-2])
    lane = np.vstack([path[0] - (rear + _BEHIND) * first, path, path[-1] + _BEYOND * last])
    speed = np.abs(tracks.speed[rows])
    frames = tracks.frame[rows]
    duration = float(frames[-1] - frames[0]) / recording.frame_rate
    top = max(round(float(speed.max()), 2), 1.0)
    document = tomlkit.document()
    document["description"] = (
        f"In place of vehicle {vehicle} of {recording.dataset.name}, {recording.name}, among the "
        "people who were there"
    )
    document["time_limit"] = round(duration + _PATIENCE, 1)
    document["ego"] = {
        "route": [DRIVE],
        "lane": 0,
        "depart_time": 0.0,
        "depart_position": round(rear + _BEHIND + front, 3),
        "initial_speed": round(float(speed[0]), 3),
        "travel_distance": round(float(np.hypot(*np.diff(path, axis=0).T).sum()), 3),
    }
    document["vehicle"] = {"length": front + rear, "width": width}
    document["regulation"] = {"reference_speed": top}
    document["crowd"] = {
        "host_edge": GATE,
        "zone": "none",
        "model": "recorded",
        "recorded": [
            {
                "name": "recorded",
                "path": str(recording.file.absolute()),
                "dataset": dataset,
                "clip": recording.name,
                "begin": round(0.0 - float(frames[0]) / recording.frame_rate, 6),
                "vehicle": str(vehicle),
                "walk_on": _WALK_ON,
            }
        ],
    }
    return {
        f"{name}.net.xml": network_along(lane, max(top, 13.89)),
        f"{name}.sumocfg": configuration_of(name, duration + _PATIENCE),
        f"{name}.giveway.toml": tomlkit.dumps(document),
    }


def _number(recording: Recording, vehicle: str | None) -> int:
    """Return the index of a vehicle that drives.

    Raises:
        ConfigError: it is not named, or not there.
        DatasetError: it is parked.
    """
    vehicles = recording.vehicles
    parks = parked(vehicles)
    driving = [each for each, stands in zip(vehicles.ids, parks, strict=True) if not stands]
    if vehicle is None or vehicle not in vehicles.ids:
        given = "missing" if vehicle is None else f"{vehicle}: no such id"
        hint = suggestion(vehicle or "", driving) if driving else "no vehicle drives there"
        raise ConfigError(f"--vehicle {given} in '{recording.name}'; {hint}")
    if vehicle not in driving:
        raise DatasetError(
            f"--vehicle {vehicle}: is parked in '{recording.name}'; expected a vehicle that "
            f"drives: {', '.join(driving) or 'there is none'}"
        )
    return vehicles.ids.index(vehicle)


def _path(position: Array, frame_rate: float) -> Array:
    """Return points (k, 2) [m] of a path, some metres apart, from the first place to the last."""
    window = max(1, round(_SMOOTHED * frame_rate))
    averages = pd.DataFrame(position).rolling(window, center=True, min_periods=1).mean()
    smooth = averages.to_numpy(copy=True)
    smooth[0], smooth[-1] = position[0], position[-1]
    kept = [smooth[0]]
    for place in smooth[1:]:
        if np.hypot(*(place - kept[-1])) >= _APART:
            kept.append(place)
    rest = float(np.hypot(*(smooth[-1] - kept[-1])))
    if rest > 0.0 and len(kept) > 1:
        if rest < _APART / 2.0:
            kept.pop()
        kept.append(smooth[-1])
    return np.array(kept)


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.hypot(*vector))
