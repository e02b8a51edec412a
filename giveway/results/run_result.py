"""What a run leaves behind: tracks, tables, summaries."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from giveway.config import EgoRunConfig, RunConfig
from giveway.config.layers import dump_toml
from giveway.config.presets import parameters_of
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.metrics import (
    PEDESTRIAN_FIELDS,
    SUMMARY_FIELDS,
    VehicleContact,
    conflicts,
    pedestrian_metrics,
    summarise,
    vehicle_contacts,
)
from giveway.recording.recorded import RecordedRows
from giveway.records.columns import (
    EGO_COLUMNS,
    PREDICTION_COLUMNS,
    SUMMARY_HEAD,
    TIMING_COLUMNS,
    TRAJECTORY_COLUMNS,
    Column,
)
from giveway.records.progress import Ending
from giveway.records.tracks import BackgroundTrack, CrowdTrack, EgoTrack, PredictionTrack, Timings
from giveway.results.tables import ego_table, prediction_table, timing_table, trajectory_table
from sumo_scenarios import Scenario


@dataclass(frozen=True)
class EgoResult:
    """What one ego leaves behind.

    Attributes:
        config: of the ego.
        id: in SUMO.
        shape: its body.
        goal: the distance [m] after which it is done.
        first: the control instant at which it departed.
        track: its rows, from that instant on.
        ending: why its drive ended.
        crowd: the crowd's records of these instants, counted from ``first``.
        predictions: what its controller expected of the crowd, if that was recorded.
        background: the background vehicles of the run.
    """

    config: EgoRunConfig
    id: str
    shape: VehicleShape
    goal: float
    first: int
    track: EgoTrack
    ending: Ending
    crowd: CrowdTrack
    predictions: PredictionTrack
    background: BackgroundTrack

    @property
    def body_radius(self) -> float:
        """The pedestrians' body radius [m]."""
        return float(parameters_of(self.config.crowd.preset).body_radius)

    @cached_property
    def pedestrians(self) -> pd.DataFrame:
        """One row per pedestrian: closest approach to this ego, TTC, PET."""
        return pedestrian_metrics(self.track, self.crowd, self.shape, self.body_radius)

    @cached_property
    def vehicle_contacts(self) -> tuple[VehicleContact, ...]:
        """The background vehicles that it came into contact with."""
        return vehicle_contacts(self.track, self.background, self.shape)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The drive in one row."""
        config = self.config
        body = self.shape, self.body_radius
        figures = summarise(
            self.track,
            self.pedestrians,
            conflicts(self.track, self.crowd, *body, config.record.stop_speed),
            goal=self.goal,
            safe_distance=config.regulation.safe_distance,
            stop_speed=config.record.stop_speed,
            controller=config.controller,
            vehicles=self.vehicle_contacts,
        )
        return figures.as_dict()


@dataclass(frozen=True)
class RunResult:
    """Everything that a run left behind; the frames hold the columns of docs/results.md.

    Attributes:
        config: the configuration in effect.
        scenario: the scenario's files.
        ending: why the run ended.
        error: what ended it, if it failed.
        time: (T,) [s] the control instants.
        egos: the egos that were on the road, in the order of their departure.
        crowd_track, background_track: the rows as arrays, in SI units.
        elapsed: wall clock of the loop [s].
        manifest: versions, hashes, seeds, the pedestrians' ledger.
        sumo_messages: what SUMO printed.
        road: outlines (k, 2) [m] of the network's lanes, crossings and walkingareas.
        remarks: what differs from the scenario, or from what the user may expect.
    """

    config: RunConfig
    scenario: Scenario
    ending: Ending
    error: Exception | None
    time: Array
    egos: tuple[EgoResult, ...]
    crowd_track: CrowdTrack
    background_track: BackgroundTrack
    timings: Timings
    elapsed: float
    manifest: dict[str, Any]
    sumo_messages: str
    road: tuple[Array, ...]
    remarks: tuple[str, ...]

    @property
    def completed(self) -> bool:
        """Whether every ego has driven its distance."""
        return self.ending is Ending.COMPLETED

    @property
    def config_text(self) -> str:
        """The effective configuration as TOML."""
        return dump_toml(self.config)

    @property
    def ego_track(self) -> EgoTrack:
        """The first ego's rows.

        Raises:
            LookupError: no ego was on the road.
        """
        if not self.egos:
            raise LookupError(
                "this run had no ego on the road; look at crowd_track and background_track"
            )
        return self.egos[0].track

    @property
    def shape(self) -> VehicleShape:
        """The first ego's body."""
        return self.egos[0].shape if self.egos else VehicleShape()

    @property
    def body_radius(self) -> float:
        """The pedestrians' body radius [m]."""
        return float(parameters_of(self.config.crowd.preset).body_radius)

    @cached_property
    def ego(self) -> pd.DataFrame:
        """One row per control instant and ego."""
        names = [column.name for column in EGO_COLUMNS]
        tables = [ego_table(ego.track, ego.id) for ego in self.egos]
        return _stacked(tables, names, by="time")

    @cached_property
    def trajectories(self) -> pd.DataFrame:
        """Everybody's position and velocity, SUMO's FCD names."""
        egos = [(ego.id, ego.track) for ego in self.egos]
        return trajectory_table(self.time, egos, self.crowd_track, self.background_track)

    @cached_property
    def pedestrians(self) -> pd.DataFrame:
        """One row per ego and pedestrian: closest approach, TTC, PET."""
        tables = [table.assign(ego=ego.id) for ego in self.egos for table in [ego.pedestrians]]
        return _stacked(tables, [column.name for column in PEDESTRIAN_TABLE])

    @cached_property
    def predictions(self) -> pd.DataFrame:
        """One row per control instant, ego, pedestrian and look-ahead, if it was asked for."""
        names = [column.name for column in PREDICTION_COLUMNS]
        ids = self.crowd_track.ids
        tables = [prediction_table(ego.predictions, ego.id, ids) for ego in self.egos]
        return _stacked(tables, names, by="time")

    @cached_property
    def timing(self) -> pd.DataFrame:
        """Computing times per control step; the only table that differs between equal runs."""
        return timing_table(self.time, self.timings)

    @property
    def head(self) -> dict[str, Any]:
        """The run's settings and ending: the first columns of the summary."""
        return {
            "scenario": self.scenario.name,
            "controller": self.config.controller,
            "pedestrians": len(self.crowd_track.ids),
            "seed": self.config.seed,
            "ending": str(self.ending),
        }

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The run in one row, that of its first ego; without an ego, the head alone."""
        return self.head | (self._row(self.egos[0]) if self.egos else {})

    def _row(self, ego: EgoResult) -> dict[str, Any]:
        head = {"controller": ego.config.controller, "ending": str(ego.ending), "ego": ego.id}
        return self.head | head | ego.summary

    @property
    def summary_table(self) -> pd.DataFrame:
        """One row per ego."""
        names = [column.name for column in self.schemas["summary"]]
        return pd.DataFrame([self._row(ego) for ego in self.egos], columns=names)

    @property
    def timing_summary(self) -> dict[str, Any]:
        """Wall clock, real-time factor and each part's share of the loop."""
        simulated = float(self.time[-1] - self.time[0]) if len(self.time) else 0.0
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
        predicted = self.config.record.predictions is not None
        optional = {"predictions": PREDICTION_COLUMNS} if predicted else {}
        return {
            "ego": EGO_COLUMNS,
            "trajectories": TRAJECTORY_COLUMNS,
            "pedestrians": PEDESTRIAN_TABLE,
            "summary": (*SUMMARY_HEAD, *SUMMARY_FIELDS),
            "timing": TIMING_COLUMNS,
            **optional,
        }


def results_of_egos(
    config: RunConfig, rows: RecordedRows, ending: Ending, endings: Mapping[str, Ending]
) -> tuple[EgoResult, ...]:
    """What each ego leaves behind.

    Args:
        config: the run's.
        rows: the run's.
        ending: of the run.
        endings: of those egos whose drive ended by itself.
    """
    crowd, background = rows.crowd_track(), rows.background_track()
    configs = {own.ego_id: own for own in config.each_ego()}
    return tuple(
        EgoResult(
            config=configs[ego.id],
            id=ego.id,
            shape=ego.shape,
            goal=ego.goal,
            first=ego.first,
            track=ego.track,
            ending=endings.get(ego.id, ending),
            crowd=crowd.during(ego.first, len(ego.track.time)),
            predictions=ego.predictions,
            background=background,
        )
        for ego in rows.egos()
    )


PEDESTRIAN_TABLE = (
    Column("ego", "string", None, "SUMO id of the ego that the row is about"),
    *PEDESTRIAN_FIELDS,
)


def _stacked(tables: list[pd.DataFrame], names: list[str], by: str | None = None) -> pd.DataFrame:
    """The tables one below the other, with the columns ``names``, perhaps ordered."""
    if not tables:
        return pd.DataFrame(columns=names)
    table = tables[0] if len(tables) == 1 else pd.concat(tables, ignore_index=True)
    if by is not None and len(tables) > 1:
        table = table.sort_values(by, kind="stable", ignore_index=True)
    return table[names]
