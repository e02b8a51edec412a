"""A step of a large crowd in domains, one per thread, with results equal to the last bit.

Each domain owns the pedestrians of some strips of the cell list, and has its own workspace. The
force on a pedestrian is a sum in the order of the tiles (``cell_list.py``). Each summand depends on
the old state alone. A tile adds forces to its own strip and to the strips within reach above it. A
domain therefore visits the tiles of its own strips, and of the *ghost* strips within reach below,
in the order of a sequential step. All forces on its own pedestrians are added there, in the same
order.

For a ghost tile only candidates of the domain are evaluated, because the sum of a candidate does
not depend on the other candidates. Forces on pedestrians of the domain above stay in the workspace
and are not used. Vehicles, walls, targets and the integration concern each pedestrian alone. Thus
the result does not depend on the number of domains, and no domain waits for another one.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, inner, kernel
from pedestrian_model.arrays import Arrays
from pedestrian_model.stepping import FINE, first_insane
from pedestrian_model.vci.buffers import (
    FX,
    FY,
    NVX,
    NVY,
    NX,
    NY,
    PRIORITY,
    ROWS,
    STRIDE,
    Workspace,
    aligned,
    fill,
)
from pedestrian_model.vci.destination import set_targets
from pedestrian_model.vci.detour import detour
from pedestrian_model.vci.pairs.cell_list import (
    _TILE,
    Grid,
    Strips,
    _find_segments,
    _lay_grid,
    _meet_candidates,
    _sort,
)
from pedestrian_model.vci.pairs.pair_force import add_coincident, pair_constants
from pedestrian_model.vci.step import _integrate, any_priority, parts
from pedestrian_model.vci.vehicle_force import Traffic, add_vehicles_to_strips
from pedestrian_model.vci.wall_force import add_walls

#: Index in the layout at which the strips follow the grid.
_GRID = len(Grid._fields)
_GHOST = 0.25  # work of a ghost relative to a pedestrian (benchmarks/speed/bench_crowd.py)


class DomainMemory:
    """The memory of one domain.

    Attributes:
        arrays: Rows (ROWS + 1, capacity), with one more row for shifted views; buffer of the pair
            loops; segments (4, 16).
    """

    arrays: Arrays

    def __init__(self) -> None:
        self._buffer = aligned(10 * STRIDE)
        self._segments = np.zeros((4, 16), dtype=np.int64)
        self._capacity = -1

    def reserve(self, workspace: Workspace) -> None:
        """Make room for as many pedestrians as the workspace has."""
        if workspace.capacity > self._capacity:
            self._capacity = workspace.capacity
            columns = workspace.arrays[0].shape[1]
            rows = aligned((ROWS + 1) * columns).reshape(ROWS + 1, columns)
            self.arrays = (rows, self._buffer, self._segments)


def layout_memory(threads: int) -> NDArray[np.float64]:
    """Return the layout that ``lay_out`` fills: grid, first strip of each domain, end."""
    return np.zeros(_GRID + threads + 1)


@inlined
def _halo(grid: Grid) -> int:
    """Return the number of strips above its own that a tile reaches."""
    return int(grid.reach * grid.per_y) + 1


@kernel
def lay_out(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    index: NDArray[np.int64],
    layout: NDArray[np.float64],
    constants: NDArray[Any],
) -> int:
    """Sort the crowd into cells and divide the strips; return ``FINE`` or the first bad index.

    All domains have about the same number of pedestrians. A ghost counts as a quarter, because few
    candidates of its tile belong to the domain. There are fewer domains, of which the last own
    nothing, if they would consist mostly of ghosts.
    """
    n = position.shape[0]
    insane = first_insane(position, velocity)
    if insane != FINE:
        return insane
    grid = _lay_grid(position, constants[0].r_max, index.shape[1] - 2)
    _sort(index, position, grid)
    first, columns, strips, halo = index[2], grid.columns, grid.strips, _halo(grid)
    layout[0], layout[1], layout[2], layout[3] = grid.x_0, grid.y_0, grid.per_x, grid.per_y
    layout[4], layout[5], layout[6], layout[7] = columns, strips, grid.reach, grid.slack
    most = layout.shape[0] - _GRID - 1
    domains = max(1, min(most, strips // (2 * halo)))
    strip, work = 0, 0.0
    ghosts = n * _GHOST * halo / strips  # work of a domain's ghosts, in pedestrians
    whole = n + ghosts * (domains - 1)
    for domain in range(most + 1):
        layout[_GRID + domain] = strips
    layout[_GRID] = 0.0
    for domain in range(1, domains):
        while strip < strips and work < domain * whole / domains - ghosts * (domain - 1):
            strip += 1
            work = float(first[strip * columns])
        layout[_GRID + domain] = strip
    return FINE


@inner
def _add_pairs(
    rows: NDArray[np.float64],
    index: NDArray[np.int64],
    memory: tuple[NDArray[np.float64], NDArray[np.int64]],
    strips: Strips,
    filled: int,
    constants: NDArray[Any],
) -> None:
    """Add the forces of all pairs to the rows of the domain's strips.

    Args:
        rows: Rows of the domain, filled as far as its tiles and those of its ghosts reach.
        index: Order of the pedestrians, and cells.
        memory: Buffer and segments of the domain.
        strips: Strips of the domain.
        filled: Index of the last filled row, plus one.
        constants: Constants of the model.
    """
    c = pair_constants(constants[0])
    (buffer, segments), (grid, begin_strip, end_strip) = memory, strips
    order, first = index[0], index[2]
    own = first[begin_strip * grid.columns]
    for strip in range(max(0, begin_strip - _halo(grid)), end_strip):
        for left in range(0, grid.columns, _TILE):
            begin = first[strip * grid.columns + left]
            end = first[strip * grid.columns + min(left + _TILE, grid.columns)]
            if begin == end:
                continue
            count = _find_segments(rows, first, segments, begin, end, strip, grid)
            if strip < begin_strip:
                count = _keep_own(segments, count, own)
            if _meet_candidates(rows, begin, end, segments, count, buffer, c) > 0:
                for i in range(begin, end):
                    add_coincident(rows, order, i, filled, c)


@inlined
def _keep_own(segments: NDArray[np.int64], count: int, own: int) -> int:
    """Remove the segments before row ``own``, and return the number of those that are left."""
    kept = 0
    for k in range(count):
        if segments[0, k] >= own:
            segments[0, kept], segments[1, kept] = segments[0, k], segments[1, k]
            kept += 1
    return kept


@inlined
def _shifted(rows: NDArray[np.float64], by: int) -> NDArray[np.float64]:
    """Return a contiguous view (ROWS, columns) from column ``by`` on, with invalid last columns."""
    columns = rows.shape[1]
    return rows.reshape(-1)[by : by + ROWS * columns].reshape(ROWS, columns)


@kernel
def step_domain(
    arrays: Arrays,
    memory: Arrays,
    layout: NDArray[np.float64],
    domain: int,
    after: NDArray[np.float64],
    traffic: tuple[NDArray[np.float64], float],
    law: tuple[NDArray[Any], float],
) -> None:
    """Compute the next state of one domain's pedestrians, and pass their way-points.

    Args:
        arrays: Arrays of State, Scene and Scratch, one after the other. Only the sorting of the
            scratch is read, and only the way-point index of the state is changed.
        memory: Arrays of ``DomainMemory``.
        layout: Layout, filled by ``lay_out``.
        domain: Number of the domain.
        after: Next positions and velocities (n, 4), filled.
        traffic: Vehicles (m, 7), and the time [s] for which they have driven straight on.
        law: Constants of the model, and the length dt [s] of the step.
    """
    (vehicles, travelled), (constants, dt) = traffic, law
    state, scene, scratch = parts(arrays)
    rows, buffer, segments = memory
    begin_strip, end_strip = int(layout[_GRID + domain]), int(layout[_GRID + domain + 1])
    if begin_strip >= end_strip:
        return
    c, index = constants[0], scratch.sorting
    grid = Grid(
        layout[0],
        layout[1],
        layout[2],
        layout[3],
        int(layout[4]),
        int(layout[5]),
        layout[6],
        layout[7],
    )
    order, first, halo = index[0], index[2], _halo(grid)
    start, stop = first[begin_strip * grid.columns], first[end_strip * grid.columns]
    begin = first[max(0, begin_strip - halo) * grid.columns]
    filled = first[min(grid.strips, end_strip + halo) * grid.columns]
    fill(_shifted(rows, begin), order[begin:filled], state.position, state.velocity)
    strips = Strips(grid, begin_strip, end_strip)
    _add_pairs(rows, index, (buffer, segments), strips, filled, constants)
    mine, who, n = _shifted(rows, start), order[start:stop], stop - start
    relied_on = any_priority(scene.priority)
    if relied_on:
        for k in range(n):
            mine[PRIORITY, k] = scene.priority[who[k]]
    among = Traffic(vehicles, travelled, relied_on)
    add_vehicles_to_strips(rows, first, strips, among, constants)
    at, walls = state.waypoint_index, (scene.walls, scene.wall_cells)
    add_walls(mine, n, FX, FY, walls, (who, at, scene.routes), c)
    set_targets(mine, who, scene.desired_speed, scene.routes, at, scene.closed, c)
    detour(mine, n, vehicles, c)
    _integrate(mine, n, dt, c)
    for k in range(n):
        i = who[k]
        after[i, 0], after[i, 1] = mine[NX, k], mine[NY, k]
        after[i, 2], after[i, 3] = mine[NVX, k], mine[NVY, k]


@kernel
def write_back(
    position: NDArray[np.float64], velocity: NDArray[np.float64], after: NDArray[np.float64]
) -> int:
    """Copy the next state into the present one, and return ``FINE`` or the first bad index."""
    for i in range(position.shape[0]):
        position[i, 0], position[i, 1] = after[i, 0], after[i, 1]
        velocity[i, 0], velocity[i, 1] = after[i, 2], after[i, 3]
    return first_insane(position, velocity)
