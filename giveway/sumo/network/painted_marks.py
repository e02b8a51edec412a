"""The crossings of the loaded network and the stop lines of its lights, for pictures."""

import numpy as np

from giveway.geometry.kernel import Array
from giveway.run_data.road_marks import Point, RoadMarks, SignalHead, Zebra
from giveway.sumo.network.lanes import Lanes


def road_marks(lanes: Lanes) -> RoadMarks:
    """Return all crossings and stop lines, to a centimetre."""
    zebras = tuple(Zebra(_ends(*one.ends), round(one.width, 2)) for one in lanes.crossings)
    return RoadMarks(zebras, stop_lines(lanes))


def stop_lines(lanes: Lanes) -> tuple[SignalHead, ...]:
    """Return the stop line of each lane for vehicles that a traffic light governs."""
    governed: dict[tuple[str, str], list[int]] = {}
    for (source, _), (system, index) in lanes.signals.items():
        if not source.startswith(":"):  # people enter crossings from walkingareas
            governed.setdefault((source, system), []).append(index)
    found = []
    for (lane, system), links in governed.items():
        before, end = lanes.shape(lane)[-2:]
        length = max(float(np.hypot(*(end - before))), 1e-9)
        along = (end - before) / length
        end = end - lanes.stop_offset(lane) * along
        aside = lanes.width(lane) / 2 * np.array((-along[1], along[0]))
        ends = _ends(end + aside, end - aside)
        found.append(SignalHead(ends, system, tuple(sorted(links))))
    return tuple(found)


def _ends(one: Array, other: Array) -> tuple[Point, Point]:
    (a, b), (c, d) = (np.round((one, other), 2) + 0.0).tolist()
    return (a, b), (c, d)
