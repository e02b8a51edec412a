"""The pictures of a run, and the one of the vehicle's influence."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from giveway.config.files.naming import title
from giveway.errors import ResultsError, remedy
from giveway.figures import (
    crowd_view_figure,
    influence_figure,
    save_figure,
    state_figure,
    top_view_figure,
)
from giveway.figures.conflict_points import Conflict
from giveway.figures.density import density_figure
from giveway.figures.sight_view import SightView
from giveway.figures.state import FARTHEST_SHOWN
from giveway.figures.top_view import Backdrop
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.measures import density_map
from giveway.results.ego_result import EgoResult
from giveway.results.names import MARKS
from giveway.results.run_tables import RunTables
from giveway.run_data.tracks import counted
from pedestrian_model import VciParameters, Vehicles, vehicle_influence


def write_pictures(result: RunTables, folder: Path) -> None:
    """Write the pictures of every ego, or only the trajectories in a run without an ego.

    The pictures of the first ego are ``state.png`` and ``top_view.png``, of the second
    ``state_2.png`` ...

    Raises:
        ResultsError: a file cannot be written.
    """
    try:
        _write_pictures(result, folder)
    except OSError as error:
        raise ResultsError(
            f"{folder}: a picture cannot be written ({error.strerror}); {remedy(error)}"
        ) from error


def _write_pictures(result: RunTables, folder: Path) -> None:
    for ego, mark in zip(result.egos, MARKS, strict=False):
        save_figure(state_picture(result, ego), folder / f"state{mark}.png")
        if not result.crowd_track.is_long:
            save_figure(top_view_picture(result, ego), folder / f"top_view{mark}.png")
    if result.crowd_track.is_long:
        return
    if result.config.measure and len(result.crowd_track.x) > 1:
        save_figure(density_picture(result), folder / "density.png")
    if not result.egos and result.crowd_track.x.size:
        save_figure(crowd_picture(result), folder / "top_view.png")


def state_picture(result: RunTables, ego: EgoResult) -> Figure:
    """Draw speed, force and gap over time, with the phases of MPC and PID (the paper's figure)."""
    return state_figure(
        ego.track,
        safe_distance=ego.config.regulation.safe_distance,
        buffer_distance=ego.config.buffer_distance,
        stop_lines=_stop_lines(ego),
        title=_title(result, ego),
    )


def _stop_lines(ego: EgoResult) -> list[float]:
    """Return the positions [m] on an ego's track at which traffic lights held it."""
    if ego.law is None or not ego.track.position.size:
        return []
    way, last = ego.law.way, ego.track.position[-1] + FARTHEST_SHOWN
    places = (line.station - way.departure for line in way.lines)
    return [place for place in places if 0.0 <= place <= last]


def top_view_picture(result: RunTables, ego: EgoResult) -> Figure:
    """Draw trajectories and snapshots from above (the paper's screenshots figure)."""
    return top_view_figure(
        ego.track,
        ego.crowd,
        ego.shape,
        ego.body_radius,
        backdrop=Backdrop(
            result.road,
            result.marks,
            result.signal_track,
            result.background_track,
            _conflicts(ego),
            _sight(result, ego),
        ),
        title=_title(result, ego),
    )


def _sight(result: RunTables, ego: EgoResult) -> SightView | None:
    """Return the sight of an ego with cameras."""
    if result.opaque is None:
        return None
    sights = result.sights
    return SightView.of(ego.config, sights[sights["ego"] == ego.id], result.opaque)


def _conflicts(ego: EgoResult) -> list[Conflict]:
    """Return severity and place of each of an ego's conflicts."""
    found = ego.conflicts[ego.conflicts["severity"] != ""]
    columns = ("severity", "conflict_x", "conflict_y")
    return list(zip(*(found[name] for name in columns), strict=True))


def density_picture(result: RunTables) -> Figure:
    """Draw the mean density of the people over the run, and the places of conflicts."""
    people = counted(len(result.crowd_track.ids))
    return density_figure(
        density_map(result.crowd_track, len(result.time)),
        result.config.measure,
        conflicts=[conflict for ego in result.egos for conflict in _conflicts(ego)],
        title=title(result.config, result.scenario.name, people),
    )


def crowd_picture(result: RunTables) -> Figure:
    """Draw the trajectories of a run without an ego."""
    people = counted(len(result.crowd_track.ids))
    return crowd_view_figure(
        result.time,
        result.crowd_track,
        road=result.road,
        title=title(result.config, result.scenario.name, people),
    )


def _title(result: RunTables, ego: EgoResult) -> str:
    who = "" if ego.id == "ego" else f"ego {ego.id}, {ego.config.driver}"
    return title(ego.config, result.scenario.name, counted(len(result.crowd_track.ids)), who)


def influence_picture(
    speeds: Sequence[float], shape: VehicleShape, parameters: VciParameters
) -> Figure:
    """Draw the vehicle's influence on a standing pedestrian (the paper's figure 2)."""

    def influence(points: Array, speed: float) -> Array:
        half = shape.length / 2
        vehicle = Vehicles.create(0.0, 0.0, 0.0, speed, half, half, shape.width)
        return vehicle_influence(points, np.zeros_like(points), vehicle, parameters)[0]

    return influence_figure(influence, speeds=speeds, shape=shape)
