"""The result of one ego of a run: its rows, and the measures computed from them."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from controller import WorstMotion
from controller.driving_constants import COMFORTABLE
from giveway.config import EgoRunConfig
from giveway.config.files.presets import parameters_of
from giveway.config.option import LANE
from giveway.ego.people_assumed import people_at_worst
from giveway.geometry.bodies import VehicleShape
from giveway.journal.recorded import RecordedEgo, RecordedRows
from giveway.metrics import (
    DELAY_FIELDS,
    DriveSetting,
    VehicleContact,
    anticipation,
    critical_encounters,
    severities,
    summarise,
    vehicle_contacts,
)
from giveway.metrics.baseline import summarise_baseline
from giveway.metrics.law import Drive, Ledger, Undisturbed, ledger
from giveway.metrics.pedestrians import pedestrian_columns, table_of
from giveway.metrics.plugged_in import NOTHING_MEASURED, Measured
from giveway.metrics.travel import SignalDelay, signal_delays, summarise_travel
from giveway.results.effect import Effect
from giveway.results.law import LawRows, others_of, people_from
from giveway.run_data.outputs import Output
from giveway.run_data.progress import Ending
from giveway.run_data.tracks import (
    NO_SIGHTS,
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PredictionTrack,
    SightTrack,
)
from giveway.sumo.plain_drive import PlainDrives

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class EgoResult:
    """The result of one ego.

    Attributes:
        config: Configuration of the ego.
        id: Id of the ego in SUMO.
        shape: Body of the ego.
        goal: Distance [m] after which its drive is complete.
        first: Control instant at which it departed.
        track: Rows of the ego, from that instant on.
        ending: Reason why its drive ended.
        crowd: Records of the crowd at these instants, counted from ``first``.
        predictions: Positions of the crowd that its controller expected, if recorded.
        background: Background vehicles of the run.
        road: Path and rows by which its drive is judged, or None if they are not recorded.
        outputs: Outputs that the profile of its FMU has recorded.
        effect: Comparison of the people with those of the counterfactual run, or None without one.
        measured: Columns that metrics of other packages measured; empty if the run was recovered.
        hasty: Indices of people whose sudden start broke its safety layer's assumption.
        sights: Changes of who is in sight of an ego of the run.
        plain: Drives of plain SUMO for the same trip, or None if there was to be none.
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
    outputs: tuple[Output, ...] = ()
    road: LawRows | None = None
    effect: Effect | None = None
    measured: Measured = NOTHING_MEASURED
    hasty: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    sights: SightTrack = NO_SIGHTS
    plain: PlainDrives | None = None

    @property
    def body_radius(self) -> float:
        """The body radius [m] of the pedestrians."""
        return float(parameters_of(self.config.crowd.preset).body_radius)

    @cached_property
    def pedestrians(self) -> "pd.DataFrame":
        """The table with one row per pedestrian: closest approach to this ego, TTC, PET; delay."""
        import pandas as pd

        table = table_of(self._columns)
        if self.effect is None:
            return table
        found = self.effect.delays
        columns = found.delay, found.basis, found.detour, self.effect.yielded[self.id]
        names = [column.name for column in DELAY_FIELDS]
        more = pd.DataFrame(dict(zip(names, columns, strict=True)), index=self.effect.run.ids)
        more = more.reindex(table["id"]).reset_index(drop=True)
        return table.assign(**{name: more[name] for name in names})

    @cached_property
    def _columns(self) -> dict[str, Any]:
        """The columns of :attr:`pedestrians` without the delays."""
        return pedestrian_columns(self.track, self.crowd, self.shape, self.body_radius)

    @cached_property
    def conflicts(self) -> "pd.DataFrame":
        """The table with one row per pedestrian: severity, time, speed and place by TTC and PET."""
        body = self.shape, self.body_radius, self.config.record.stop_speed
        return severities(self.track, self.crowd, *body, self.pedestrians)

    @cached_property
    def vehicle_contacts(self) -> tuple[VehicleContact, ...]:
        """The background vehicles with which it had contact."""
        return vehicle_contacts(self.track, self.background, self.shape)

    @property
    def law(self) -> LawRows | None:
        """The rows by which its drive is judged, or None if no rule applies on its path."""
        return self.road if self.road is not None and self.road.way.is_ruled else None

    @cached_property
    def drive(self) -> Drive | None:
        """The drive along its path, or None if the path is not recorded."""
        if self.road is None:
            return None
        return Drive(
            ego=self.track,
            shape=self.shape,
            body_radius=self.body_radius,
            way=self.road.way,
            crowd=self.crowd,
            people=self.road.people,
            signals=self.road.signals,
            vehicles=self.road.vehicles,
            comfortable=COMFORTABLE,
            goal=self.goal,
            stop_speed=self.config.record.stop_speed,
            undisturbed=self._undisturbed,
        )

    @cached_property
    def ledger(self) -> Ledger | None:
        """The judgement by the law of the road, or None if no rule applies on its path."""
        if self.law is None or self.drive is None:
            return None
        return ledger(self.drive, self.vehicle_contacts)

    @cached_property
    def signal_delays(self) -> tuple[SignalDelay, ...]:
        """The delay at each traffic light that it passed."""
        return () if self.drive is None else signal_delays(self.drive, self._fastest)

    @property
    def _fastest(self) -> float:
        """The highest speed [m/s] at which it would drive on a free road."""
        wanted = self.config.reference_speed
        fastest = self.config.vehicle.speed_max
        return fastest if wanted == LANE else min(float(wanted), fastest)

    @property
    def _undisturbed(self) -> Undisturbed | None:
        """Return the people of the counterfactual run, with their indices in the run's crowd."""
        if self.effect is None:
            return None
        twin, places = self.effect.twin, {name: k for k, name in enumerate(self.crowd.ids)}
        place = np.array([places.get(name, -1) for name in twin.ids], dtype=np.int64)
        who = place[twin.pedestrian]
        known = who >= 0
        steps = twin.step[known] - self.first
        return Undisturbed(steps, who[known], twin.x[known], twin.y[known])

    @property
    def people_at_worst(self) -> WorstMotion | None:
        """The worst motion of people that its safety layer assumes, or None without a layer."""
        config = self.config
        if not config.safety_layer:
            return None
        return people_at_worst(config)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The summary of the drive in one row."""
        config = self.config
        body = self.shape, self.body_radius
        set_speed = config.reference_speed
        reference = None if set_speed == LANE else float(set_speed)
        figures = summarise(
            self.track,
            self._columns,
            critical_encounters(self.track, self.crowd, *body, config.record.stop_speed),
            anticipation(
                self.track,
                self.crowd,
                *body,
                reference_speed=reference,
                stop_speed=config.record.stop_speed,
            ),
            DriveSetting(
                self.goal,
                config.regulation.safe_distance,
                config.controller_name,
                reference,
                config.record.stop_speed,
                self.people_at_worst,
            ),
            hasty=self.hasty,
            vehicles=self.vehicle_contacts,
        )
        row = asdict(figures)
        if self.ledger is not None:
            row |= asdict(self.ledger.summary)
        if self.law is not None and self.drive is not None:
            row |= asdict(summarise_travel(self.drive, self.signal_delays, self._fastest))
        if self.effect is not None:
            row |= asdict(self.effect.summary(self.id))
        if self.plain is not None:
            row |= asdict(summarise_baseline(self.track, self.goal, self.plain))
        row |= self.measured.values
        return row


def results_of_egos(
    configs: Mapping[str, EgoRunConfig],
    rows: RecordedRows,
    ending: Ending,
    endings: Mapping[str, Ending],
) -> tuple[EgoResult, ...]:
    """Return the result of each ego.

    Args:
        configs: Configuration of each ego, by its id.
        rows: Recorded rows of the run.
        ending: Reason why the run ended.
        endings: Reason of each ego whose drive ended before the run.
    """
    crowd, background = rows.crowd_track(), rows.background_track()
    sights = rows.sight_track()
    ways, signals, people = rows.ways(), rows.signal_track(), rows.people_track()
    recorded = list(rows.egos())

    def road_of(ego: RecordedEgo) -> LawRows | None:
        if ego.id not in ways:
            return None
        others = others_of(ego, recorded, background)
        return LawRows(ways[ego.id], signals, people_from(people, ego.first), others)

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
            outputs=ego.outputs,
            road=road_of(ego),
            hasty=ego.hasty,
            sights=sights,
        )
        for ego in recorded
    )
