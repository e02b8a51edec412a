"""The table ``measures.csv``: PedPy's results on each line and area, interval by interval."""

import importlib.util
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from giveway.config.tables.measures import MeasureConfig
from giveway.errors import ResultsError
from giveway.measures.columns import MEASURE_COLUMNS
from giveway.measures.service import FRUIN, HCM, level_of_service
from giveway.measures.trajectories import surroundings, trajectory_data, walks
from giveway.run_data.tracks import CrowdTrack

if TYPE_CHECKING:
    import pandas as pd

CUT_OFF = 1.0  # Largest distance [m] of a Voronoi cell's edge from its person
SAMPLING = 0.25  # Time [s] between the instants at which an area is measured
SPEED_WINDOW = 0.2  # Time [s] over which PedPy computes speeds from positions


def require_pedpy() -> None:
    """Make sure that PedPy is installed before anything is computed, without importing it.

    Raises:
        ResultsError: PedPy is missing.
    """
    if importlib.util.find_spec("pedpy") is None:
        raise ResultsError(
            "[[measure]] and density maps need PedPy; install it with: "
            "pip install 'giveway[analysis]'"
        )


def measure_table(
    measures: Sequence[MeasureConfig], time: NDArray[np.float64], crowd: CrowdTrack
) -> "pd.DataFrame":
    """Return one row per measure and interval, with the columns of ``MEASURE_COLUMNS``.

    Args:
        measures: Lines and areas.
        time: Control instants (T,) [s], evenly spaced.
        crowd: Track of the crowd.
    """
    import pandas as pd

    names = [column.name for column in MEASURE_COLUMNS]
    if len(time) < 2:
        return pd.DataFrame(columns=names)
    table = walks(crowd)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # PedPy warns if nobody crosses a line, which is a result
        rows = [
            row
            for measure in measures
            for row in (_line_rows if measure.line else _area_rows)(measure, time, table)
        ]
    found = pd.DataFrame(rows, columns=names)
    return found.astype({"crossings": "Int64", "crossed": "Int64"})


def _intervals(measure: MeasureConfig, time: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Return the control instants at which each interval begins and before which it ends."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    length = max(1, round(measure.interval / step))
    last = len(time) - 1  # there is nothing an instant later
    return [(begin, min(begin + length, last)) for begin in range(0, last, length)]


def _speeds(table: "pd.DataFrame", step: float) -> "tuple[Any, pd.DataFrame]":
    """Return PedPy's trajectories, and every person's speed [m/s] at each frame."""
    from pedpy import SpeedCalculation, compute_individual_speed

    data = trajectory_data(table, step)
    speeds = compute_individual_speed(
        traj_data=data,
        frame_step=max(1, round(SPEED_WINDOW / step / 2)),
        speed_calculation=SpeedCalculation.BORDER_SINGLE_SIDED,
    )
    return data, speeds


def _line_rows(
    measure: MeasureConfig, time: NDArray[np.float64], table: "pd.DataFrame"
) -> list[dict[str, Any]]:
    step = float(time[-1] - time[0]) / (len(time) - 1)
    frames, speeds = np.empty(0, dtype=np.int64), np.empty(0)
    if len(table):
        from pedpy import MeasurementLine, compute_n_t

        data, individual = _speeds(table, step)
        _, crossing = compute_n_t(traj_data=data, measurement_line=MeasurementLine(measure.line))
        crossing = crossing.merge(individual, on=["id", "frame"], how="left")
        frames, speeds = crossing["frame"].to_numpy(), crossing["speed"].to_numpy()
    (x_0, y_0), (x_1, y_1) = measure.line
    length = float(np.hypot(x_1 - x_0, y_1 - y_0))
    rows = []
    for begin, end in _intervals(measure, time):
        # A crossing belongs to the first frame beyond the line. In the last interval, the last
        # frame counts.
        last = end if end == len(time) - 1 else end - 1
        here = (frames >= begin) & (frames <= last)
        flow = int(here.sum()) / float(time[end] - time[begin])
        rows.append(
            {
                **_head(measure, "line", time, begin, end),
                "speed": float(np.nanmean(speeds[here])) if here.any() else np.nan,
                "crossings": int(here.sum()),
                "crossed": int((frames <= last).sum()),
                "flow": flow,
                "specific_flow": flow / length,
                "service_fruin": level_of_service(FRUIN, specific_flow=flow / length),
                "service_hcm": level_of_service(HCM, specific_flow=flow / length),
            }
        )
    return rows


def _area_rows(
    measure: MeasureConfig, time: NDArray[np.float64], table: "pd.DataFrame"
) -> list[dict[str, Any]]:
    step = float(time[-1] - time[0]) / (len(time) - 1)
    looked_at = np.arange(0, len(time) - 1, max(1, round(SAMPLING / step)))
    classic, voronoi, speed = _area_series(measure, looked_at, step, table)
    rows = []
    for begin, end in _intervals(measure, time):
        here = (looked_at >= begin) & (looked_at < end)
        if not here.any():
            continue
        density = float(voronoi[here].mean())
        known = speed[here][np.isfinite(speed[here])]
        rows.append(
            {
                **_head(measure, "area", time, begin, end),
                "people": float(classic[here].mean()) * _size(measure),
                "classic_density": float(classic[here].mean()),
                "density": density,
                "peak_density": float(voronoi[here].max()),
                "speed": float(known.mean()) if len(known) else np.nan,
                "service_fruin": level_of_service(FRUIN, density=density),
                "service_hcm": level_of_service(HCM, density=density),
            }
        )
    return rows


def _area_series(
    measure: MeasureConfig, looked_at: NDArray[np.int64], step: float, table: "pd.DataFrame"
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return both densities [1/m^2] and the mean speed [m/s] at the frames ``looked_at``."""
    nobody = np.zeros(len(looked_at))
    sampled = table[table["frame"].isin(looked_at)]
    if not len(sampled):
        return nobody, nobody, np.full(len(looked_at), np.nan)
    from pedpy import (
        Cutoff,
        MeasurementArea,
        compute_classic_density,
        compute_individual_voronoi_polygons,
        compute_mean_speed_per_frame,
        compute_voronoi_density,
    )

    area = MeasurementArea(measure.area)
    _, individual = _speeds(table, step)
    data = trajectory_data(sampled, step)
    polygons = compute_individual_voronoi_polygons(
        traj_data=data,
        walkable_area=surroundings(sampled, np.array(measure.area), 2.0 * CUT_OFF),
        cut_off=Cutoff(radius=CUT_OFF, quad_segments=3),
    )
    found = {
        "classic": compute_classic_density(traj_data=data, measurement_area=area),
        "voronoi": compute_voronoi_density(individual_voronoi_data=polygons, measurement_area=area)[
            0
        ],
        "speed": compute_mean_speed_per_frame(
            traj_data=data, individual_speed=individual, measurement_area=area
        ),
    }
    series = {
        name: _by_frame(frame, looked_at).to_numpy(dtype=np.float64)
        for name, frame in found.items()
    }
    occupied = series["classic"] > 0.0
    return (
        np.nan_to_num(series["classic"]),
        np.nan_to_num(series["voronoi"]),
        np.where(occupied, series["speed"], np.nan),
    )


def _by_frame(found: "pd.DataFrame", looked_at: NDArray[np.int64]) -> "pd.Series":
    """Return PedPy's value at each frame, nan without one."""
    if "frame" in found.columns:
        found = found.set_index("frame")
    return found.iloc[:, -1].reindex(looked_at)


def _size(measure: MeasureConfig) -> float:
    """Return the size [m^2] of an area, by the shoelace formula."""
    x, y = np.array(measure.area).T
    return float(abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) / 2.0)


def _head(
    measure: MeasureConfig, kind: str, time: NDArray[np.float64], begin: int, end: int
) -> dict[str, Any]:
    return {
        "measure": measure.name,
        "kind": kind,
        "begin": float(time[begin]),
        "end": float(time[end]),
    }
