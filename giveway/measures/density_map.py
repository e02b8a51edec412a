"""The map of people's density: PedPy's classic density on a grid, averaged over a run."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from giveway.measures.trajectories import surroundings, walks
from giveway.run_data.tracks import CrowdTrack

CELL = 0.5  # Side [m] of a grid's cell
SAMPLES = 200  # Largest number of instants in the mean


@dataclass(frozen=True)
class DensityMap:
    """The mean density on a grid.

    Attributes:
        density: Density (rows, columns) [1/m^2], the northern row first.
        left, bottom, right, top: Edges [m] of the grid.
    """

    density: NDArray[np.float64]
    left: float
    bottom: float
    right: float
    top: float


def density_map(crowd: CrowdTrack, instants: int) -> DensityMap:
    """Return the mean density over a run.

    Args:
        crowd: Track of the crowd.
        instants: Number of instants of the run; those without people count, too.

    Raises:
        ValueError: nobody was recorded.
    """
    from pedpy import DensityMethod, compute_density_profile, get_grid_cells

    table = walks(crowd)
    if not len(table):
        raise ValueError("density map: nobody was recorded; pass a track of at least two records")
    frames = np.arange(0, instants, max(1, instants // SAMPLES))
    ground = surroundings(table, np.empty((0, 2)), 2.0 * CELL)
    sampled = table[table["frame"].isin(frames)]
    _, rows, columns = get_grid_cells(walkable_area=ground, grid_size=CELL)
    total = np.zeros((rows, columns))
    for profile in compute_density_profile(
        data=sampled, walkable_area=ground, grid_size=CELL, density_method=DensityMethod.CLASSIC
    ):
        total += profile
    left, _, _, top = ground.bounds
    right, bottom = left + columns * CELL, top - rows * CELL
    return DensityMap(total / len(frames), left, bottom, right, top)
