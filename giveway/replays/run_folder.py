"""A results folder as a replay reads it, whether the run was completed or not."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pandas as pd

from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.layers import build_config, read_toml
from giveway.errors import ConfigError, ResultsError
from giveway.gate import DEFINITIONS, LARGEST_TABLE, MANIFEST, opened, read_json
from giveway.geometry.kernel import Array
from giveway.metrics.pedestrians import PEDESTRIAN_FIELDS
from giveway.run_data.columns import (
    PREDICTION_COLUMNS,
    SIGHT_COLUMNS,
    SIGNAL_COLUMNS,
    TRAJECTORY_COLUMNS,
    Column,
)
from giveway.run_data.scene import Scene
from giveway.run_data.seal import Form, is_sealed, require_sealed
from giveway.run_data.tracks import EGO_COLUMNS

PREDICTIONS = "predictions.csv"
# Columns with a number in every row
_ALWAYS = frozenset({"time", "look_ahead", "x", "y", "vx", "vy", "angle", "speed", "position"})
_SHOWN = 40  # Characters shown of a text that is not a number


@dataclass(frozen=True)
class RunFolder:
    """The content of a results folder that a replay needs.

    Attributes:
        config: Configuration of the run.
        egos: Configuration of each ego that has rows, by its id, in the order of departure.
        ego, trajectories, pedestrians: Tables of the same names.
        summary: Content of ``summary.json``: the first ego's row, and all rows under ``egos`` if
            there are several.
        manifest: Content of ``manifest.json``.
        scene: Road and bodies.
        signals: Recorded states of the lights with their times; empty if none is recorded.
        sights: Recorded stretches of time in sight; empty without a sensor.
        time: Instants (T,) [s] that have a row.
    """

    path: Path
    config: RunConfig
    egos: dict[str, EgoRunConfig]
    ego: pd.DataFrame
    trajectories: pd.DataFrame
    pedestrians: pd.DataFrame
    summary: dict[str, Any]
    manifest: dict[str, Any]
    scene: Scene
    signals: pd.DataFrame
    sights: pd.DataFrame
    time: Array

    @property
    def step(self) -> float:
        """The control step [s] according to the rows."""
        known = self.manifest.get("time_step")
        if isinstance(known, int | float):
            return float(known)
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 0.05

    @property
    def sumo_step(self) -> float:
        """The step of SUMO [s], or the control step if it is not known."""
        sumo = self.manifest.get("sumo")
        known = sumo.get("step_length") if isinstance(sumo, dict) else None
        return float(known) if isinstance(known, int | float) else self.step

    @property
    def seal_note(self) -> str:
        """The remark that nobody can tell whether the tables are the run's, or "" with a seal."""
        if is_sealed(self.manifest):
            return ""
        return f"{self.path}: has no seal (an earlier giveway wrote it): changes go unnoticed"

    def rows_of(self, ego: str) -> dict[str, Any]:
        """Return the summary's row of one ego."""
        rows = self.summary.get("egos", [self.summary])
        rows = [row for row in rows if isinstance(row, dict)] if isinstance(rows, list) else []
        return next((row for row in rows if row.get("ego") == ego), {})

    def sights_of(self, ego: str) -> pd.DataFrame:
        """Return the rows of one ego in ``sights.csv``."""
        return self.sights[self.sights["ego"] == ego] if len(self.sights) else self.sights

    @classmethod
    def read(cls, folder: Path, *, unsealed: bool = False) -> RunFolder:
        """Read a folder that ``giveway run`` wrote.

        Args:
            folder: Results folder.
            unsealed: True to read tables that differ from those that the run wrote.

        Raises:
            ResultsError: the folder holds no run, or one of its files cannot be read or is not what
                the run wrote.
        """
        _require_run(folder)
        manifest = _json(folder / MANIFEST)
        if not unsealed:
            require_sealed(folder, manifest)
        try:
            config = build_config([read_toml(folder / "config.toml")])
        except ConfigError as error:
            raise ResultsError(f"{error}; expected a folder that 'giveway run' wrote") from error
        ego = _table(folder / "ego.csv", EGO_COLUMNS)
        trajectories = _table(_trajectories(folder), TRAJECTORY_COLUMNS)
        time = np.union1d(*(rows["time"].to_numpy(np.float64) for rows in (ego, trajectories)))
        if not len(time):
            raise ResultsError(f"{folder}: the run left no rows; there is nothing to play")
        configs = {own.ego_id: own for own in config.each_ego()}
        unnamed = EgoRunConfig.model_validate(config.model_dump(exclude={"egos"}))
        return cls(
            path=folder,
            config=config,
            egos={name: configs.get(name, unnamed) for name in ego["id"].unique()},
            ego=ego,
            trajectories=trajectories,
            pedestrians=_table(folder / "pedestrians.csv", PEDESTRIAN_FIELDS),
            summary=_json(folder / "summary.json"),
            manifest=manifest,
            scene=Scene.read(folder),
            signals=_table(folder / "signals.csv", SIGNAL_COLUMNS),
            sights=_table(folder / "sights.csv", SIGHT_COLUMNS),
            time=time,
        )


def read_predictions(file: Path) -> pd.DataFrame:
    """Read the table ``predictions.csv``.

    Raises:
        ResultsError: the file cannot be read.
    """
    return _table(file, PREDICTION_COLUMNS)


def _require_run(folder: Path) -> None:
    needed = ("config.toml", "manifest.json", "ego.csv", _trajectories(folder).name)
    missing = [name for name in needed if not (folder / name).is_file()]
    if not missing:
        return
    for kind, definition in DEFINITIONS.items():
        if (folder / definition).is_file():
            raise ResultsError(
                f"{folder}: a {kind} with many runs; make one again by giveway rerun {folder} RUN "
                f"(runs.csv has their ids), and name {folder}/reruns/RUN"
            )
    if not folder.is_dir():
        what = "a file" if folder.exists() else "no such folder"
    elif len(missing) == len(needed) - 1 and (folder / "manifest.json").exists():
        what = "a run is still writing there, or was killed"
    else:
        what = f"no run in it ('{missing[0]}' is missing)"
    raise ResultsError(f"{folder}: {what}; expected a results folder that 'giveway run' wrote")


def _trajectories(folder: Path) -> Path:
    """Return the file of the trajectories, which has one of three forms."""
    names = [f"trajectories.{form}" for form in get_args(Form)]
    return next((folder / name for name in names if (folder / name).exists()), folder / names[0])


def _table(file: Path, columns: tuple[Column, ...]) -> pd.DataFrame:
    """Read a table in which ids are texts, even those of digits only.

    Missing texts become empty ones.
    """
    texts = {column.name: str for column in columns if column.type == "string"}
    try:
        with opened(file, largest=LARGEST_TABLE) as stream:
            frame = (
                pd.read_parquet(stream)
                if file.suffix == ".parquet"
                else pd.read_csv(
                    stream,
                    dtype={"ego": str} | texts,
                    na_values=[""],
                    keep_default_na=False,
                    compression="gzip" if file.suffix == ".gz" else None,
                )
            )
    except FileNotFoundError:
        return pd.DataFrame()
    except OSError as error:
        raise ResultsError(f"{file}: cannot be read ({error.strerror or error})") from error
    except ImportError:
        raise ResultsError(
            f"{file}: Parquet needs pyarrow; install it with: pip install 'giveway[parquet]'"
        ) from None
    except (ValueError, EOFError, zlib.error, pd.errors.ParserError) as error:
        reason = " ".join(str(error).split())
        raise ResultsError(
            f"{file}: not a table of giveway ({reason}); make the run again"
        ) from error
    missing = [column.name for column in columns if column.name not in frame]
    if missing:
        raise ResultsError(
            f"{file}: column '{missing[0]}' is missing; make the run again with this giveway"
        )
    text = list(texts)
    frame[text] = frame[text].fillna("")
    for column in columns:
        if column.type != "string":
            _require_numbers(file, frame[column.name], column.name in _ALWAYS)
    return frame


def _require_numbers(file: Path, column: pd.Series, always: bool) -> None:
    """Make sure that a column holds numbers; ``always`` means that no number may be missing."""
    numbers = pd.to_numeric(column, errors="coerce").to_numpy(np.float64)
    bad = np.isnan(numbers) & column.notna().to_numpy()
    if always:
        bad |= ~np.isfinite(numbers)
    if bad.any():
        row = int(np.argmax(bad))
        found = "nothing" if pd.isna(column.iloc[row]) else repr(str(column.iloc[row])[:_SHOWN])
        raise ResultsError(
            f"{file}: line {row + 2}, column '{column.name}': {found}; expected a number, as "
            "giveway wrote it; make the run again"
        )


def _json(file: Path) -> dict[str, Any]:
    try:
        return read_json(file)
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ResultsError(f"{file}: cannot be read ({error}); make the run again") from error
