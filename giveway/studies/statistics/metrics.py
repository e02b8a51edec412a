"""The metrics of a run that studies compare, and which direction is better."""

from collections.abc import Iterable
from dataclasses import dataclass

from giveway.errors import ConfigError, suggestion
from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.run_data.columns import Column, Direction


@dataclass(frozen=True)
class Metric:
    """One column of a run's summary, as a study compares it.

    Attributes:
        name: Name of the column.
        unit: Unit of the column; empty for shares and counts.
        better: Direction that is better.
        label: Name in tables and pictures.
    """

    name: str
    unit: str
    better: Direction
    label: str


_UNITS = {column.name: column.unit or "" for column in EGO_FIELDS}


def _lower(name: str, label: str) -> Metric:
    return Metric(name, _UNITS[name], "lower", label)


def _higher(name: str, label: str) -> Metric:
    return Metric(name, _UNITS[name], "higher", label)


METRICS = (
    _lower("completion_time", "completion time"),
    _lower("longest_wait", "longest wait"),
    _lower("total_wait", "total wait"),
    _lower("stops", "stops"),
    _higher("mean_speed", "mean speed"),
    _lower("peak_deceleration", "peak deceleration"),
    _lower("rms_jerk", "RMS jerk"),
    _lower("peak_jerk", "peak jerk"),
    _higher("mpc_feasibility_rate", "feasibility rate of the MPC"),
    _lower("safety_share", "share of the safety layer"),
    _lower("close_passes", "close passes"),
    _lower("close_pass_share", "share of close passes"),
    _lower("close_pass_share_moving", "share of close passes, moving"),
    _lower("tight_passes", "tight passes"),
    _lower("narrow_passes", "narrow passes"),
    _higher("minimum_gap", "minimum gap"),
    _lower("share_below_safe_distance", "share below the safe distance"),
    _higher("minimum_clearance", "minimum clearance"),
    _lower("overlaps", "overlaps"),
    _lower("frontal_contacts", "frontal contacts"),
    _lower("side_contacts", "side contacts"),
    _lower("overlap_time", "overlap time"),
    _higher("minimum_ttc", "minimum time to collision"),
    _lower("conflicts", "serious conflicts"),
    _lower("people_below_ttc", "people below the TTC limit"),
    _lower("share_below_ttc", "share of time below the TTC limit"),
    _higher("minimum_pet", "minimum post-encroachment time"),
    _lower("share_below_pet", "share of people with a short post-encroachment time"),
    _lower("share_below_pet_person_first", "share of people whom the ego came close after"),
    _lower("maximum_drac", "maximum deceleration to avoid a crash"),
    _higher("minimum_ttc_moving", "minimum time to collision while moving"),
    _higher("ttc_at_slowing", "time to collision as slowing begins"),
    _lower("time_among_people", "time standing among people"),
    _higher("yielding_rate", "yielding rate"),
    _lower("failures_to_yield", "failures to yield"),
    _lower("red_lights_run", "red lights run"),
    _lower("blocked_crossings", "blocked crossings"),
    _lower("blocked_junctions", "blocked junctions"),
    _lower("pushed_back", "farthest pushed back"),
    _lower("stops_without_cause", "stops without cause"),
    _lower("mean_zebra_wait", "mean wait at zebras"),
    _lower("longest_zebra_wait", "longest wait at zebras"),
    _lower("people_delay", "people's delay, all together"),
    _lower("mean_people_delay", "people's delay"),
    _lower("people_delay_95", "people's delay, 95th percentile"),
    _lower("worst_people_delay", "people's worst delay"),
    _lower("share_gave_way", "share of people who gave way"),
    _lower("traffic_delay", "delay of background vehicles"),
)


def metric(name: str) -> Metric:
    """Return the metric of that name.

    Raises:
        ConfigError: there is no such metric.
    """
    for known in METRICS:
        if known.name == name:
            return known
    hint = suggestion(name, [known.name for known in METRICS])
    raise ConfigError(f"metric '{name}': no such number to compare; {hint}")


def compared(columns: Iterable[Column]) -> tuple[Metric, ...]:
    """Return giveway's metrics, and those of other packages that say which direction is better.

    Args:
        columns: Columns that metrics of other packages have added.
    """
    own = (
        Metric(column.name, column.unit or "", column.better, column.name.replace("_", " "))
        for column in columns
        if column.better is not None
    )
    return (*METRICS, *own)
