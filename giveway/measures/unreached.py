"""The lines and areas that nobody reaches, mostly because of a wrong coordinate."""

from collections.abc import Sequence

import shapely

from giveway.config.tables.measures import MeasureConfig
from giveway.run_data.tracks import CrowdTrack

NEAR = 1.0  # Distance [m] within which a person reaches a line or an area


def unreached(measures: Sequence[MeasureConfig], crowd: CrowdTrack) -> tuple[str, ...]:
    """Return a remark on each measure that nobody reached, with the places where people walked."""
    if not measures:
        return ()
    if not len(crowd.x):
        return tuple(f"[[measure]] {m.name}: nobody walked in this run" for m in measures)
    points = shapely.points(crowd.x, crowd.y)
    walked = (
        f"people walked in x {crowd.x.min():.1f} to {crowd.x.max():.1f} m, "
        f"y {crowd.y.min():.1f} to {crowd.y.max():.1f} m (network coordinates)"
    )
    remarks = []
    for measure in measures:
        shape = shapely.LineString if measure.line else shapely.Polygon
        distance = float(shapely.distance(shape(measure.places), points).min())
        if distance > NEAR:
            remarks.append(
                f"[[measure]] {measure.name}: nobody came nearer than {distance:.1f} m; {walked}"
            )
    return tuple(remarks)
