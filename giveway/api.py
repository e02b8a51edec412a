"""The Python API: one call, one run, everything it left behind."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import pandas as pd

from giveway.assembly import assemble
from giveway.configfile import dump_toml
from giveway.errors import GivewayError
from giveway.interrupts import DeferredInterrupt
from giveway.loading import as_layer, load
from giveway.manifest import manifest
from giveway.metrics import PEDESTRIAN_FIELDS, SUMMARY_FIELDS, pedestrian_metrics, summarise
from giveway.recorder import Recorder
from giveway.results import (
    release_folder,
    require_parquet,
    take_folder,
    write_pictures,
    write_results,
)
from giveway.schema import EGO_COLUMNS, TIMING_COLUMNS, TRAJECTORY_COLUMNS, Column
from giveway.simulation import Ending, Loop, Watcher
from giveway.tables import ego_table, timing_table, trajectory_table
from giveway.tracks import BackgroundTrack, CrowdTrack, EgoTrack, Timings, VehicleShape
from pedestrian_model import PRESETS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from giveway.config import RunConfig
    from sumo_scenarios import Scenario


@dataclass(frozen=True)
class RunResult:
    """Everything that a run left behind; the frames hold the columns of docs/results.md.

    Attributes:
        config: the configuration in effect.
        scenario: the scenario's files.
        ending: why the run ended.
        error: what ended it, if it failed.
        ego_track, crowd_track, background_track: the rows as arrays, in SI units.
        manifest: versions, hashes, seeds, the pedestrians' ledger.
        sumo_messages: what SUMO printed.
        lanes: centre line (k, 2) [m] and width [m] of the network's lanes.
    """

    config: RunConfig
    scenario: Scenario
    ending: Ending
    error: Exception | None
    ego_track: EgoTrack
    crowd_track: CrowdTrack
    background_track: BackgroundTrack
    timings: Timings
    elapsed: float  # [s] wall clock of the loop
    manifest: dict[str, Any]
    sumo_messages: str
    lanes: tuple[tuple[NDArray[np.float64], float], ...]

    @property
    def completed(self) -> bool:
        """Whether the ego has driven its distance."""
        return self.ending is Ending.COMPLETED

    @property
    def config_text(self) -> str:
        """The effective configuration as TOML."""
        return dump_toml(self.config)

    @property
    def shape(self) -> VehicleShape:
        """The ego's body."""
        return VehicleShape(self.config.vehicle.length, self.config.vehicle.width)

    @property
    def body_radius(self) -> float:
        """The pedestrians' body radius [m]."""
        return float(PRESETS[self.config.crowd.preset].body_radius)

    @cached_property
    def ego(self) -> pd.DataFrame:
        """One row per control instant."""
        return ego_table(self.ego_track, self.config.ego.id)

    @cached_property
    def trajectories(self) -> pd.DataFrame:
        """Everybody's position and velocity, SUMO's FCD names."""
        ego_id = self.config.ego.id
        return trajectory_table(self.ego_track, ego_id, self.crowd_track, self.background_track)

    @cached_property
    def pedestrians(self) -> pd.DataFrame:
        """One row per pedestrian: closest approach, TTC, PET."""
        return pedestrian_metrics(self.ego_track, self.crowd_track, self.shape, self.body_radius)

    @cached_property
    def timing(self) -> pd.DataFrame:
        """Computing times per control step; the only table that differs between equal runs."""
        return timing_table(self.ego_track.time, self.timings)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The run in one row."""
        config = self.config
        head = {
            "scenario": self.scenario.name,
            "controller": config.controller,
            "pedestrians": config.crowd.pedestrians,
            "seed": config.seed,
            "ending": str(self.ending),
        }
        figures = summarise(
            self.ego_track,
            self.pedestrians,
            goal=config.ego.travel_distance,
            safe_distance=config.regulation.safe_distance,
            controller=config.controller,
        )
        return head | figures.as_dict()

    @property
    def summary_table(self) -> pd.DataFrame:
        """The summary as a table of one row."""
        return pd.DataFrame([self.summary])

    @property
    def timing_summary(self) -> dict[str, Any]:
        """Wall clock, real-time factor and each part's share of the loop."""
        simulated = float(self.ego_track.time[-1] - self.ego_track.time[0])
        whole = self.timings.total("total")
        shares = {name: self.timings.total(name) / whole for name in Timings.NAMES[:-1] if whole}
        return {
            "wall_clock": self.elapsed,
            "real_time_factor": simulated / self.elapsed if self.elapsed else None,
            "shares": shares,
        }

    @property
    def schemas(self) -> dict[str, tuple[Column, ...]]:
        """The columns of each CSV file."""
        return {
            "ego": EGO_COLUMNS,
            "trajectories": TRAJECTORY_COLUMNS,
            "pedestrians": PEDESTRIAN_FIELDS,
            "summary": (*_SUMMARY_HEAD, *SUMMARY_FIELDS),
            "timing": TIMING_COLUMNS,
        }


_SUMMARY_HEAD = (
    Column("scenario", "string", None, "the scenario's name"),
    Column("controller", "string", None, "the controller that was asked for"),
    Column("pedestrians", "integer", "persons", "pedestrians added"),
    Column("seed", "integer", None, "seed of the crowd and of SUMO"),
    Column("ending", "string", None, "completed, time limit, scenario end, interrupted or failed"),
)


def run(
    config: RunConfig | dict[str, Any] | str | Path,
    *,
    results: str | Path | None = None,
    force: bool = False,
    parquet: bool = False,
    pictures: bool = True,
    watcher: Watcher | None = None,
) -> RunResult:
    """Drive the ego through the crowd once.

    Args:
        config: the options that differ from the scenario's settings and the defaults, as a
            ``RunConfig`` or as nested dictionaries with the keys of the TOML file; or the name of
            a scenario, or a .toml file.
        results: a folder to write tables, summary, manifest and pictures to; None writes nothing.
        force: replace the results that are there.
        parquet: also write the tables as Parquet.
        pictures: also draw the state figure and the top view.
        watcher: called with a ``Progress`` at every control step.

    Returns:
        The result. A run that was interrupted (Ctrl-C) returns too; see its ``ending``.

    Raises:
        GivewayError: one line that says what to do. If the run had begun, its rows are written
            all the same and the partial result is the error's ``result`` attribute.
    """
    return run_layers(
        [as_layer(config)],
        results=results,
        force=force,
        parquet=parquet,
        pictures=pictures,
        watcher=watcher,
    )


def run_layers(
    layers: list[Any],
    *,
    results: str | Path | None,
    force: bool = False,
    parquet: bool = False,
    pictures: bool = True,
    watcher: Watcher | None = None,
) -> RunResult:
    """As :func:`run`, from layers of settings with their origins."""
    config, scenario = load(layers)
    folder = None if results is None else Path(results)
    if parquet:
        require_parquet()
    taken = folder is not None and take_folder(folder, force=force)
    with DeferredInterrupt() as interrupt:  # writing is not to be torn either
        try:
            result = simulate(config, scenario, watcher, interrupt)
        except Exception:
            if folder is not None and taken:
                release_folder(folder)
            raise
        if folder is not None and len(result.ego_track.time):
            write_results(result, folder, parquet=parquet)
            if pictures:
                write_pictures(result, folder)
        elif folder is not None and taken:
            release_folder(folder)
    if result.error is not None:
        if isinstance(result.error, GivewayError):
            result.error.result = result
        raise result.error
    return result


def simulate(
    config: RunConfig,
    scenario: Scenario,
    watcher: Watcher | None = None,
    interrupt: DeferredInterrupt | None = None,
) -> RunResult:
    """Run one configuration; an error on the way becomes the result's ``error``.

    Args:
        config: the effective configuration.
        scenario: its scenario.
        watcher: called at every control step.
        interrupt: looked at between two steps.

    Raises:
        GivewayError: the run could not begin.
    """
    with ExitStack() as stack:
        parts = assemble(config, scenario, stack)
        recorder = Recorder(parts.spawned.ids)
        loop = Loop(parts, recorder)
        began = perf_counter()
        error: Exception | None = None
        try:
            ending = loop.run(watcher, lambda: interrupt is not None and interrupt.requested)
        except Exception as failure:  # whatever it is, the rows so far are the user's
            error, ending = failure, Ending.FAILED
        elapsed = perf_counter() - began
        return RunResult(
            config=config,
            scenario=scenario,
            ending=ending,
            error=error,
            ego_track=recorder.ego_track(),
            crowd_track=recorder.crowd_track(),
            background_track=recorder.background_track(),
            timings=recorder.timings(),
            elapsed=elapsed,
            manifest=manifest(
                config,
                scenario,
                config_text=dump_toml(config),
                vehicle=parts.vehicle_description,
                pedestrians=loop.ledger,
                ending=str(ending),
                error=None if error is None else str(error),
            ),
            sumo_messages=parts.sumo.messages,
            lanes=tuple(parts.sumo.lanes.areas()),
        )
