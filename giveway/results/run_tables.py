"""The numbers of a run: tracks, tables and summaries."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml
from giveway.config.files.presets import parameters_of
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.measures import MEASURE_COLUMNS, measure_table
from giveway.metrics import (
    DELAY_FIELDS,
    DELAY_SUMMARY_FIELDS,
    PEDESTRIAN_FIELDS,
    SEVERITY_FIELDS,
    SUMMARY_FIELDS,
    WALK_SUMMARY_FIELDS,
    summarise_walks,
    walks_without_ego,
)
from giveway.metrics.baseline import BASELINE_FIELDS
from giveway.metrics.law import LAW_FIELDS
from giveway.metrics.travel import SIGNAL_DELAY_FIELDS, TRAVEL_FIELDS
from giveway.metrics.waiting import WAITING_FIELDS, waiting_by_footway
from giveway.results.effect import Effect
from giveway.results.ego_result import EgoResult
from giveway.results.frames import framed, stacked
from giveway.results.inputs import sha256
from giveway.results.law import ledger_table, people_table, signal_table
from giveway.results.provenance import CONFIGURATION
from giveway.results.sights import sight_table
from giveway.results.tables import ego_table, prediction_table, timing_table, trajectory_pieces
from giveway.run_data.columns import (
    LEDGER_COLUMNS,
    PEOPLE_COLUMNS,
    PREDICTION_COLUMNS,
    SEEN,
    SIGHT_COLUMNS,
    SIGNAL_COLUMNS,
    SUMMARY_HEAD,
    TIMING_COLUMNS,
    TRAJECTORY_COLUMNS,
    Column,
)
from giveway.run_data.footways import NO_FOOTWAYS, Footways
from giveway.run_data.progress import Ending
from giveway.run_data.road_marks import UNMARKED, RoadMarks
from giveway.run_data.scene import Opaque
from giveway.run_data.tracks import (
    EGO_COLUMNS,
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PeopleTrack,
    SightTrack,
    SignalTrack,
    Timings,
)
from sumo_scenarios import Scenario

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class RunTables:
    """All data that a run left behind; the frames hold the columns of docs/results.md.

    Attributes:
        config: Configuration in effect.
        scenario: Files of the scenario.
        ending: Reason why the run ended.
        error: Error that ended the run, or None.
        time: Control instants (T,) [s].
        egos: Egos that were on the road, in the order of their departure.
        crowd_track, background_track: Rows as arrays, in SI units.
        signal_track: Changes of the traffic lights that govern something on an ego's path.
        sight_track: Changes of who is in sight of an ego, if it has a sensor.
        people_track: Planned routes of people, if the law of the road rules an ego's path.
        elapsed: Wall clock time of the loop [s].
        facts: Manifest, which may lack the hash of the configuration.
        sumo_messages: Messages that SUMO printed.
        road: Outlines (k, 2) [m] of the network's lanes, crossings and walkingareas.
        remarks: Remarks on differences from the scenario or from what the user may expect.
        effect: Comparison of the people with those of the counterfactual run, or None without one.
        marks: Crossings and stop lines of the network.
        footways: Crossings and edges on which people walk, if any of SUMO's people were moved.
        opaque: Things that hide people, or None if no ego has cameras.
    """

    config: RunConfig
    scenario: Scenario
    ending: Ending
    error: Exception | None
    time: Array
    egos: tuple[EgoResult, ...]
    crowd_track: CrowdTrack
    background_track: BackgroundTrack
    signal_track: SignalTrack
    sight_track: SightTrack
    people_track: PeopleTrack
    timings: Timings
    elapsed: float
    facts: dict[str, Any]
    sumo_messages: str
    road: tuple[Array, ...]
    remarks: tuple[str, ...]
    effect: Effect | None = None
    marks: RoadMarks = UNMARKED
    footways: Footways = NO_FOOTWAYS
    opaque: Opaque | None = None

    @property
    def completed(self) -> bool:
        """True if every ego has driven its distance."""
        return self.ending is Ending.COMPLETED

    @cached_property
    def config_text(self) -> str:
        """The effective configuration as TOML."""
        return dump_toml(self.config)

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """The contents of ``manifest.json``: versions, hashes, seeds, the ledger of pedestrians."""
        if self.facts[CONFIGURATION] is not None:
            return self.facts
        return self.facts | {CONFIGURATION: sha256(self.config_text.encode())}

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
    def ego(self) -> "pd.DataFrame":
        """The table with one row per control instant and ego."""
        names = [column.name for column in self.schemas["ego"]]
        tables = [ego_table(ego.track, ego.id, ego.outputs) for ego in self.egos]
        return stacked([table.reindex(columns=names) for table in tables], names, by="time")

    @cached_property
    def trajectories(self) -> "pd.DataFrame":
        """The table of all positions and velocities, with the names of SUMO's FCD."""
        import pandas as pd

        return pd.concat(list(self.trajectory_pieces()), ignore_index=True)

    def trajectory_pieces(self) -> "Iterator[pd.DataFrame]":
        """Yield the rows of :attr:`trajectories`, as many at a time as fit into the memory."""
        egos = [(ego.id, ego.track) for ego in self.egos]
        sights = self.sight_track if "sights" in self.schemas else None
        return trajectory_pieces(self.time, egos, self.crowd_track, self.background_track, sights)

    @cached_property
    def pedestrians(self) -> "pd.DataFrame":
        """The table with one row per ego and pedestrian: closest approach, TTC, PET, delay."""
        import pandas as pd

        names = [column.name for column in self.schemas["pedestrians"]]
        tables = [
            pd.concat([ego.pedestrians, ego.conflicts], axis=1).assign(ego=ego.id)
            for ego in self.egos
        ]
        if self.walks is not None:
            tables = [self.walks.reindex(columns=names)]
        return stacked(tables, names)

    @cached_property
    def walks(self) -> "pd.DataFrame | None":
        """The table of walks in a run without an ego, or None if it had an ego or no people."""
        if self.egos or not self.crowd_track.ids:
            return None
        record, time = self.config.record, self.time
        thin = record.far_period is not None and len(time) > 1
        every = record.steps(float(time[1] - time[0])) if thin else 1
        return walks_without_ego(self.time, self.crowd_track, every)

    @cached_property
    def predictions(self) -> "pd.DataFrame":
        """The table with one row per control instant, ego, pedestrian and look-ahead."""
        names = [column.name for column in PREDICTION_COLUMNS]
        ids = self.crowd_track.ids
        tables = [prediction_table(ego.predictions, ego.id, ids) for ego in self.egos]
        return stacked(tables, names, by="time")

    @cached_property
    def ledger(self) -> "pd.DataFrame":
        """The table with one row per encounter and violation of the law of the road."""
        judged = [(ego.id, ego.ledger) for ego in self.egos if ego.ledger is not None]
        return ledger_table([(name, event) for name, found in judged for event in found.events])

    @cached_property
    def signals(self) -> "pd.DataFrame":
        """The table of changes of the traffic lights on the egos' paths."""
        return signal_table(self.signal_track)

    @cached_property
    def sights(self) -> "pd.DataFrame":
        """The table of who was in sight of which ego, and when."""
        return sight_table(self.sight_track, self.crowd_track.ids)

    @cached_property
    def signal_delays(self) -> "pd.DataFrame":
        """The table with one row per ego and traffic light that it passed."""
        rows = [{"ego": ego.id} | asdict(one) for ego in self.egos for one in ego.signal_delays]
        return framed(rows, SIGNAL_DELAY_COLUMNS)

    @cached_property
    def waiting(self) -> "pd.DataFrame":
        """The table of the time for which people stood, by crossing and by edge."""
        return framed(
            waiting_by_footway(self.time, self.crowd_track, self.footways), WAITING_FIELDS
        )

    @cached_property
    def people(self) -> "pd.DataFrame":
        """The table of planned routes and desired speeds of people."""
        return people_table(self.time, self.people_track, self.crowd_track.ids)

    @cached_property
    def measures(self) -> "pd.DataFrame":
        """The table of density, speed and flow on each ``[[measure]]``, by interval, from PedPy."""
        return measure_table(self.config.measure, self.time, self.crowd_track)

    @cached_property
    def timing(self) -> "pd.DataFrame":
        """The table of computing times per control step, which differ between equal runs."""
        return timing_table(self.time, self.timings)

    @property
    def head(self) -> dict[str, Any]:
        """The run's settings and ending: the first columns of the summary."""
        return {
            "scenario": self.scenario.name,
            "controller": "" if self.config.ego.none else self.config.described_controller,
            "pedestrians": len(self.crowd_track.ids),
            "seed": self.config.seed,
            "ending": str(self.ending),
        }

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The summary in one row: of the first ego, or of the walks in a run without an ego."""
        if self.walks is not None:
            return self.head | asdict(summarise_walks(self.walks))
        return self.head | (self._row(self.egos[0]) if self.egos else {})

    def _row(self, ego: EgoResult) -> dict[str, Any]:
        own = {"controller": ego.config.described_controller, "ending": str(ego.ending)}
        return self.head | own | {"ego": ego.id} | ego.summary

    @property
    def summary_rows(self) -> list[dict[str, Any]]:
        """The summary of each ego, or of the walks in a run without an ego."""
        if len(self.egos) == 1 and self.walks is None:
            names = [column.name for column in self.schemas["summary"]]
            row = self._row(self.egos[0])
            return [{name: row.get(name, math.nan) for name in names}]
        # in the table, a column has one type for all rows
        rows = self.summary_table.to_dict("records")
        return [{str(name): value for name, value in row.items()} for row in rows]

    @property
    def summary_table(self) -> "pd.DataFrame":
        """The rows of the summary as a table."""
        rows = [self.summary] if self.walks is not None else [self._row(ego) for ego in self.egos]
        return framed(rows, self.schemas["summary"])

    @property
    def timing_summary(self) -> dict[str, Any]:
        """The wall clock time, the real-time factor and each part's share of the loop."""
        simulated = float(self.time[-1] - self.time[0]) if len(self.time) else 0.0
        whole = self.timings.total("total")
        shares = {name: self.timings.total(name) / whole for name in Timings.NAMES[:-1] if whole}
        return {
            "wall_clock": self.elapsed,
            "real_time_factor": simulated / self.elapsed if self.elapsed else None,
            "shares": shares,
        } | ({} if self.effect is None else {"twin": self.effect.seconds})

    @property
    def schemas(self) -> dict[str, tuple[Column, ...]]:
        """The columns of each CSV file."""
        predicted = self.config.record.predictions is not None
        optional: dict[str, tuple[Column, ...]]
        optional = {"predictions": PREDICTION_COLUMNS} if predicted else {}
        summary: tuple[Column, ...] = (*SUMMARY_HEAD, *SUMMARY_FIELDS)
        if any(ego.law is not None for ego in self.egos):
            summary = (*summary, *LAW_FIELDS, *TRAVEL_FIELDS)
            optional |= {"ledger": LEDGER_COLUMNS, "people": PEOPLE_COLUMNS}
        if self.walks is not None:
            summary = (*SUMMARY_HEAD, *WALK_SUMMARY_FIELDS)
        pedestrians = PEDESTRIAN_TABLE
        if self.effect is not None:
            summary = (*summary, *DELAY_SUMMARY_FIELDS)
            pedestrians = (*pedestrians, *DELAY_FIELDS)
        if any(ego.plain is not None for ego in self.egos):
            summary = (*summary, *BASELINE_FIELDS)
        summary = (*summary, *(own for ego in self.egos[:1] for own in ego.measured.columns))
        outputs = {output.name: output.column for ego in self.egos for output in ego.outputs}
        if len(self.signal_track.time):
            optional |= {"signals": SIGNAL_COLUMNS}
        trajectories: tuple[Column, ...] = TRAJECTORY_COLUMNS
        if any(ego.config.perception.plugged_in_sensor for ego in self.egos):
            optional |= {"sights": SIGHT_COLUMNS}
            trajectories = (*trajectories, SEEN)
        if any(ego.signal_delays for ego in self.egos):
            optional |= {"signal_delays": SIGNAL_DELAY_COLUMNS}
        if self.footways.edges:
            optional |= {"waiting": WAITING_FIELDS}
        if self.config.measure:
            optional |= {"measures": MEASURE_COLUMNS}
        return {
            "ego": (*EGO_COLUMNS, *outputs.values()),
            "trajectories": trajectories,
            "pedestrians": pedestrians,
            "summary": summary,
            "timing": TIMING_COLUMNS,
            **optional,
        }


_EGO = Column("ego", "string", None, "SUMO id of the ego that the row is about")
SIGNAL_DELAY_COLUMNS = (_EGO, *SIGNAL_DELAY_FIELDS)
PEDESTRIAN_TABLE = (_EGO, *PEDESTRIAN_FIELDS, *SEVERITY_FIELDS)
