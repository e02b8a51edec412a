"""The export of people's trajectories in the formats of PedPy and JuPedSim.

PedPy's text format is that of the Jülich data archive: a header with frame rate and unit, then id,
frame, x, y, z. JuPedSim's SQLite is its version 2 (JuPedSim 1.4): ``trajectory_data``, ``geometry``
and ``frame_data``, ``metadata``.
"""

import contextlib
import sqlite3
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.errors import ResultsError
from giveway.exports.sampling import Sampled, numbered
from giveway.replays.run_folder import RunFolder

_MARGIN = 2.0  # [m] margin of the ground around all places
_DECIMALS = 4  # decimals: a tenth of a millimetre


def write_pedpy(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write PedPy's text format.

    Returns:
        The written file, in words.

    Raises:
        ResultsError: nobody walked.
    """
    columns, names = _people(run, sampled)
    head = [
        f"# framerate: {_rate(sampled):g} fps",
        f"# frame 0 is at {sampled.begin:g} s of SUMO's clock",
        *(f"# id {number} is {name}" for number, name in enumerate(names, start=1)),
        "# id frame x/m y/m z/m",
    ]
    rows = np.column_stack([columns["id"], columns["frame"], columns["x"], columns["y"]])
    with file.open("w", encoding="utf-8", newline="\n") as out:
        out.write("\n".join(head) + "\n")
        np.savetxt(out, rows, fmt=f"%d %d %.{_DECIMALS}f %.{_DECIMALS}f 0")
    return f"{len(names)} people at {_rate(sampled):g} frames/s, for PedPy"


def write_jupedsim(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write JuPedSim's SQLite; the walkable area is the rectangle around all places.

    Returns:
        The written file, in words.

    Raises:
        ResultsError: nobody walked.
    """
    columns, names = _people(run, sampled)
    turned = np.deg2rad(90.0 - columns["angle"])
    low = [float(columns[axis].min()) - _MARGIN for axis in ("x", "y")]
    high = [float(columns[axis].max()) + _MARGIN for axis in ("x", "y")]
    ground = shapely.to_wkt(shapely.box(*low, *high), rounding_precision=_DECIMALS)
    facts = {
        "version": "2",
        "fps": f"{_rate(sampled):g}",
        "xmin": low[0],
        "xmax": high[0],
        "ymin": low[1],
        "ymax": high[1],
    }
    file.unlink(missing_ok=True)
    with contextlib.closing(sqlite3.connect(file)) as database, database:
        database.executescript(
            """
            CREATE TABLE trajectory_data (
                frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL,
                pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL);
            CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);
            CREATE TABLE geometry (hash INTEGER NOT NULL UNIQUE PRIMARY KEY, wkt TEXT NOT NULL);
            CREATE TABLE frame_data (
                frame INTEGER NOT NULL UNIQUE PRIMARY KEY, geometry_hash INTEGER NOT NULL);
            """
        )
        rows = zip(
            columns["frame"].tolist(),
            columns["id"].tolist(),
            columns["x"].round(_DECIMALS).tolist(),
            columns["y"].round(_DECIMALS).tolist(),
            np.cos(turned).round(6).tolist(),
            np.sin(turned).round(6).tolist(),
            strict=True,
        )
        database.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)", rows)
        database.executemany("INSERT INTO metadata VALUES (?, ?)", facts.items())
        database.execute("INSERT INTO geometry VALUES (1, ?)", (ground,))
        frames = ((frame, 1) for frame in range(sampled.count))
        database.executemany("INSERT INTO frame_data VALUES (?, ?)", frames)
        database.execute("CREATE INDEX frame_id_idx ON trajectory_data(frame, id)")
    return f"{len(names)} people at {_rate(sampled):g} frames/s, for JuPedSim and its viewer"


def _people(run: RunFolder, sampled: Sampled) -> tuple[dict[str, NDArray[np.int64]], list[str]]:
    """Return columns and names of the people, see :func:`numbered`."""
    people = sampled.people()
    if not people:
        raise ResultsError(f"{run.path}: nobody walked in this run; there is nothing to export")
    return numbered(people)


def _rate(sampled: Sampled) -> float:
    return round(1.0 / sampled.step, 6)
