"""The path by which a vehicle that is taken over joins its lane's centre line."""

from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import LanePath
from giveway.sumo.vehicles import VehicleState

_ON_THE_LINE = 0.01  # Largest lateral offset [m] of a vehicle on the line
_MERGE = 20.0  # Distance [m] along which a vehicle joins the line


def join(lane_path: LanePath, state: VehicleState) -> tuple[EgoPath, float, LanePath]:
    """The path of a vehicle that is taken over, the station of its front bumper, and its lane path.

    As a rule the front bumper is on the lane's centre line. A vehicle beside the line (one that
    changes lanes, or that SUMO's sublane model moves) joins it within 20 m.

    Args:
        lane_path: Lanes of its route.
        state: State of the vehicle in SUMO.
    """
    path = EgoPath.through(lane_path.points)
    station, lateral = path.locate(state.x, state.y, near=state.lane_position)
    if abs(lateral) <= _ON_THE_LINE:
        return path, station, lane_path
    share = (path.stations - station) / _MERGE
    beside = path.vertices[share > 1.0]
    joined = EgoPath.through([(state.x, state.y), *beside])
    shift = joined.length - (path.length - station)
    return joined, 0.0, lane_path.moved(joined.vertices, lambda at: at - station + shift)
