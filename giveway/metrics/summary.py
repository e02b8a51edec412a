"""The summary of a run in one row: the numbers by which runs and controllers are compared."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from controller import DECLARED, Defaults, WorstMotion
from controller.driving_constants import STANDING
from giveway.metrics.anticipation import Anticipation
from giveway.metrics.close_passes import Clearances, passes
from giveway.metrics.conflicts import Critical
from giveway.metrics.contacts import FRONTAL, SIDE
from giveway.metrics.encroachment import PERSON
from giveway.metrics.serious_conflicts import SeriousConflicts, serious
from giveway.metrics.severity import CRITICAL_PET
from giveway.metrics.slowing import slowed
from giveway.metrics.standing import waiting_times
from giveway.metrics.vehicles import VehicleContact
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.tracks import EgoTrack

if TYPE_CHECKING:
    import pandas as pd

SAFETY = "safety"  # name under which the safety layer acts
HARD = 4.0
"""Deceleration [m/s^2] above which braking is hard: more than standing passengers can bear."""
# Distance [m] ahead within which a person, vehicle or stop is the cause of a hard brake
_CAUSE = 15.0
_ROUNDING = 1.0 + 1e-6  # Relative tolerance for the rounding of velocities in a table
_FAST = Clearances._fields[1:]  # Names of the clearances above a speed
_NOBODY: NDArray[np.int64] = np.empty(0, dtype=np.int64)
_AROUND = 0.5  # Time [s] before and after the beginning of braking in which the cause is searched


@dataclass(frozen=True)
class Summary:
    """The summary's columns in their order; nan if the event never occurred."""

    completed: Annotated[bool, Quantity(None, "whether the ego reached its goal")]
    completion_time: Annotated[
        float, Quantity("s", "from the start to the goal; empty: not reached")
    ]
    simulated_time: Annotated[float, Quantity("s", "from the first to the last instant")]
    travelled_distance: Annotated[float, Quantity("m", "that the ego drove along its path")]
    mean_speed: Annotated[float, Quantity("m/s", "travelled distance over simulated time")]
    maximum_speed: Annotated[float, Quantity("m/s", "of the ego")]
    stops: Annotated[int, Quantity(None, "uninterrupted periods below the stop speed")]
    longest_wait: Annotated[float, Quantity("s", "duration of the longest stop; 0: none")]
    total_wait: Annotated[float, Quantity("s", "duration of all stops")]
    peak_deceleration: Annotated[float, Quantity("m/s^2", "largest braking of the ego; 0: none")]
    rms_jerk: Annotated[
        float, Quantity("m/s^3", "root mean square of the acceleration's difference quotient")
    ]
    peak_jerk: Annotated[
        float, Quantity("m/s^3", "largest magnitude of the acceleration's difference quotient")
    ]
    mpc_feasibility_rate: Annotated[
        float, Quantity(None, "share of steps in which the MPC acted; empty: run without MPC")
    ]
    safety_share: Annotated[float, Quantity(None, "share of steps in which the safety layer acted")]
    minimum_gap: Annotated[
        float, Quantity("m", "smallest gap to a pedestrian in front; empty: nobody was in front")
    ]
    share_below_safe_distance: Annotated[
        float, Quantity(None, "share of steps with a gap smaller than the safe distance")
    ]
    minimum_clearance: Annotated[
        float, Quantity("m", "smallest distance of a circle to the ego's rectangle, < 0: overlap")
    ]
    overlaps: Annotated[
        int, Quantity(None, "pedestrians whose circle ever overlapped the ego's rectangle")
    ]
    frontal_contacts: Annotated[int, Quantity(None, "pedestrians that the ego moved into")]
    side_contacts: Annotated[int, Quantity(None, "all other pedestrians that overlapped it")]
    overlap_time: Annotated[float, Quantity("s", "of all pedestrians, added up")]
    minimum_ttc: Annotated[
        float, Quantity("s", "smallest time to collision; empty: never on a collision course")
    ]
    conflicts: Annotated[
        int,
        Quantity(
            None, "serious conflicts: pedestrians with less time to accident than the speed needs"
        ),
    ]
    share_below_ttc: Annotated[
        float,
        Quantity(None, "share of steps at which somebody was less than 1.5 s from one"),
    ]
    minimum_pet: Annotated[
        float, Quantity("s", "smallest post-encroachment time; empty: no paths crossed")
    ]
    share_below_pet: Annotated[
        float, Quantity(None, "share of all pedestrians whose post-encroachment time is below 1 s")
    ]
    share_below_pet_person_first: Annotated[
        float, Quantity(None, "of all pedestrians those of them who were first: the ego came after")
    ]
    maximum_drac: Annotated[
        float, Quantity("m/s^2", "largest deceleration that the ego needed to spare somebody")
    ]
    minimum_ttc_moving: Annotated[
        float, Quantity("s", "smallest time to collision while the ego moved; empty: none")
    ]
    vehicle_contacts: Annotated[
        int, Quantity(None, "background vehicles whose rectangle ever overlapped the ego's")
    ]
    vehicle_contact_time: Annotated[float, Quantity("s", "of all background vehicles, added up")]
    hard_brakes: Annotated[int, Quantity(None, "periods of braking harder than 4 m/s^2")]
    hard_brakes_without_cause: Annotated[
        int, Quantity(None, "of these, with nobody, no vehicle and no stop within 15 m in front")
    ]
    slowed: Annotated[
        bool, Quantity(None, "whether it was ever below 0.8 times its speed with nobody about")
    ]
    beyond_assumption: Annotated[
        float,
        Quantity(None, "pedestrians who accelerated harder than assumed; empty: no safety layer"),
    ]
    contacts_beyond: Annotated[
        float, Quantity(None, "of these, those that the ego moved into; empty: no safety layer")
    ]
    ttc_at_slowing: Annotated[
        float,
        Quantity(
            "s", "to the first person as it began to slow, had it kept its speed; empty: none"
        ),
    ]
    time_among_people: Annotated[
        float, Quantity("s", "that it stood while people passed in front of and behind it")
    ]
    close_passes: Annotated[
        int, Quantity(None, "people closer than 0.5 m while the ego was faster than 2 m/s")
    ]
    close_pass_share: Annotated[
        float, Quantity(None, "close passes over people near; empty: nobody was near")
    ]
    close_pass_share_moving: Annotated[
        float, Quantity(None, "close passes over people near the moving ego; empty: nobody was")
    ]
    tight_passes: Annotated[
        int, Quantity(None, "people closer than 0.3 m while the ego was faster than 3 m/s")
    ]
    narrow_passes: Annotated[
        int, Quantity(None, "people closer than 0.3 m while the ego was faster than 1 m/s")
    ]
    people_near: Annotated[int, Quantity(None, "people within 4 m of the ego's rectangle")]
    people_near_moving: Annotated[
        int, Quantity(None, "people within 4 m while the ego was faster than 0.5 m/s")
    ]
    people_below_ttc: Annotated[
        int, Quantity(None, "people less than 1.5 s from a collision with the moving ego")
    ]


SUMMARY_FIELDS = columns_of(Summary)


@dataclass(frozen=True)
class DriveSetting:
    """The settings by which a drive is summarised."""

    goal: float  # [m] position that ends the run
    safe_distance: float  # [m] d_safe
    controller: str  # name of the controller
    reference_speed: float | None = None  # [m/s] v_r, or None if the lanes' limits count
    stop_speed: float = STANDING  # [m/s] speed below which the ego stands
    people: WorstMotion | None = None  # assumption of the safety layer, or None without the layer


def summarise(
    ego: EgoTrack,
    per_pedestrian: "pd.DataFrame | Mapping[str, NDArray[Any]]",
    critical: Critical,
    met: Anticipation,
    setting: DriveSetting,
    *,
    hasty: NDArray[np.int64] = _NOBODY,
    vehicles: Sequence[VehicleContact] = (),
) -> Summary:
    """Summarise a run in one row.

    A control instant stands for the time until the next one. Therefore a stop lasts from the first
    instant below the stop speed to the first one that is not, or to the end of the track. One
    uninterrupted stop is one waiting time.

    Args:
        ego: Track of the ego, at least one instant.
        per_pedestrian: Table of ``pedestrian_metrics``, or its columns.
        critical: Time to collision with the moving ego.
        met: Anticipation of the drive.
        setting: Settings of the drive. The time at which the goal is reached is interpolated
            between control instants.
        hasty: Rows of ``per_pedestrian`` of the people who left a sidewalk with a larger
            acceleration than the safety layer assumes.
        vehicles: Background vehicles with which the ego had contact.

    Raises:
        ValueError: the ego's track is empty.
    """
    if not ego.time.size:
        raise ValueError("ego track: no instants; a summary needs at least one")
    simulated_time = float(ego.time[-1] - ego.time[0])
    travelled = float(ego.position[-1] - ego.position[0])
    goal, people = setting.goal, setting.people
    waits = waiting_times(ego, setting.stop_speed)
    jerk = np.diff(ego.acceleration) / np.diff(ego.time)

    def column(name: str) -> NDArray[Any]:
        return np.asarray(per_pedestrian[name])

    clearances, encroached = column("minimum_clearance"), column("post_encroachment_time")
    conflict = SeriousConflicts(column("time_to_accident"), column("conflicting_speed"))
    passed = passes(Clearances(clearances, *(column(f"clearance_{name}") for name in _FAST)))
    near, near_moving, close, tight, narrow = (int(np.count_nonzero(of)) for of in passed)
    brakes = hard_brakes(ego)
    frontal = column("contact") == FRONTAL
    beyond = np.zeros(len(frontal), dtype=np.bool_)
    if people is not None:
        beyond = _beyond(column("peak_acceleration"), people)
    beyond[hasty] = True
    return Summary(
        completed=bool(ego.position[-1] >= goal),
        completion_time=_time_at(ego, goal),
        simulated_time=simulated_time,
        travelled_distance=travelled,
        mean_speed=travelled / simulated_time if simulated_time > 0.0 else np.nan,
        maximum_speed=float(ego.speed.max()),
        stops=waits.size,
        longest_wait=float(waits.max(initial=0.0)),
        total_wait=float(waits.sum()),
        peak_deceleration=max(0.0, -float(ego.acceleration.min())),
        rms_jerk=float(np.sqrt(np.mean(jerk**2))) if jerk.size else np.nan,
        peak_jerk=float(np.abs(jerk).max()) if jerk.size else np.nan,
        mpc_feasibility_rate=(
            float(np.mean(ego.controller == "mpc"))
            if DECLARED.get(setting.controller, Defaults()).optimises
            else np.nan
        ),
        safety_share=float(np.mean(ego.controller == SAFETY)),
        minimum_gap=_extreme(ego.gap, np.min),
        share_below_safe_distance=float(np.mean(ego.gap < setting.safe_distance)),
        minimum_clearance=_extreme(clearances, np.min),
        overlaps=int(np.count_nonzero(clearances < 0.0)),
        frontal_contacts=int(np.count_nonzero(frontal)),
        side_contacts=int(np.count_nonzero(column("contact") == SIDE)),
        overlap_time=float(np.nansum(column("overlap_time"))),
        minimum_ttc=_extreme(column("minimum_ttc"), np.min),
        conflicts=int(np.count_nonzero(serious(conflict))),
        share_below_ttc=critical.share,
        minimum_pet=_extreme(encroached, np.min),
        share_below_pet=_share(encroached < CRITICAL_PET),
        share_below_pet_person_first=_share(
            (encroached < CRITICAL_PET) & (column("passed_first") == PERSON)
        ),
        maximum_drac=_extreme(column("maximum_drac"), np.max),
        minimum_ttc_moving=critical.minimum_ttc,
        vehicle_contacts=len(vehicles),
        vehicle_contact_time=float(sum(contact.duration for contact in vehicles)),
        hard_brakes=len(brakes),
        hard_brakes_without_cause=sum(not _has_cause(ego, k) for k in brakes),
        slowed=slowed(ego, setting.reference_speed),
        beyond_assumption=float(np.count_nonzero(beyond)) if people else np.nan,
        contacts_beyond=float(np.count_nonzero(beyond & frontal)) if people else np.nan,
        ttc_at_slowing=met.ttc_at_slowing,
        time_among_people=met.time_among_people,
        close_passes=close,
        close_pass_share=close / near if near else np.nan,
        close_pass_share_moving=close / near_moving if near_moving else np.nan,
        tight_passes=tight,
        narrow_passes=narrow,
        people_near=near,
        people_near_moving=near_moving,
        people_below_ttc=critical.pedestrians,
    )


def _share(whom: NDArray[np.bool_]) -> float:
    """Return the share of the marked pedestrians, or nan without pedestrians."""
    return float(np.mean(whom)) if len(whom) else float("nan")


def _beyond(hardest: NDArray[np.float64], people: WorstMotion) -> NDArray[np.bool_]:
    """Return which pedestrians accelerated harder than ``people`` allows, beyond rounding."""
    with np.errstate(invalid="ignore"):
        return np.asarray(hardest > people.acceleration * _ROUNDING, dtype=np.bool_)


def _time_at(ego: EgoTrack, goal: float) -> float:
    """Return the time [s] since the start at which ``goal`` [m] is reached, or nan."""
    if ego.position[-1] < goal:
        return float("nan")
    k = int(np.argmax(ego.position >= goal))
    if k == 0:
        return 0.0
    before, after = ego.position[k - 1], ego.position[k]
    share = (goal - before) / (after - before)
    return float(ego.time[k - 1] - ego.time[0] + share * (ego.time[k] - ego.time[k - 1]))


def hard_brakes(ego: EgoTrack) -> NDArray[np.int64]:
    """Return the instants at which a deceleration above ``HARD`` begins.

    A pause of less than ``_AROUND`` does not end the braking.
    """
    hard = np.flatnonzero(ego.acceleration < -HARD)
    begins = np.diff(ego.time[hard], prepend=-np.inf) > _AROUND
    return np.asarray(hard[begins], dtype=np.int64)


def _has_cause(ego: EgoTrack, k: int) -> bool:
    """Return whether a person, vehicle or stop was within ``_CAUSE`` ahead at about instant k."""
    first, last = np.searchsorted(ego.time, (ego.time[k] - _AROUND, ego.time[k] + _AROUND))
    near = [gap[first : last + 1].min() for gap in (ego.gap, ego.vehicle_gap, ego.stop_gap)]
    return bool(min(near) <= _CAUSE)


def _extreme(
    values: NDArray[np.float64], extreme: Callable[[NDArray[np.float64]], np.float64]
) -> float:
    """Return the smallest or largest of the finite values, or nan if there are none."""
    finite = values[np.isfinite(values)]
    return float(extreme(finite)) if finite.size else np.nan
