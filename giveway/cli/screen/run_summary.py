"""The summary of a run on one screen."""

import math
from collections.abc import Iterator
from typing import Any

from rich.table import Column, Table
from rich.text import Text

from giveway.results.ego_result import EgoResult
from giveway.results.run_result import RunResult

_SHOWN = (
    ("Time to the goal", "completion_time", "s"),
    ("Longest wait", "longest_wait", "s"),
    ("Stops", "stops", ""),
    ("Mean speed", "mean_speed", "m/s"),
    ("RMS jerk", "rms_jerk", "m/s³"),
    ("Close passes: < 0.5 m at > 2 m/s", "close_passes", ""),
    ("of the people within 4 m", "close_pass_share", "%"),
    ("Smallest gap in front", "minimum_gap", "m"),
    ("Smallest clearance", "minimum_clearance", "m"),
    ("Pedestrians touched", "overlaps", ""),
    ("of these, the ego moved into", "frontal_contacts", ""),
    ("Serious conflicts", "conflicts", ""),
    ("People below 1.5 s to a collision", "people_below_ttc", ""),
    ("Background vehicles touched", "vehicle_contacts", ""),
    ("Smallest time to collision", "minimum_ttc", "s"),
    ("while the ego moved", "minimum_ttc_moving", "s"),
    ("Smallest post-encroachment time", "minimum_pet", "s"),
    ("Steps below the safe distance", "share_below_safe_distance", "%"),
    ("Steps in which the MPC acted", "mpc_feasibility_rate", "%"),
    ("Steps in which the safety layer acted", "safety_share", "%"),
)
_OF_THE_LAW = (  # Metrics that are shown if traffic law applies on an ego's route
    ("People met at crossings", "encounters", ""),
    ("of these let pass", "yielding_rate", "%"),
    ("Failures to yield", "failures_to_yield", ""),
    ("Red lights run", "red_lights_run", ""),
    ("Crossings blocked", "blocked_crossings", ""),
    ("Junctions blocked", "blocked_junctions", ""),
    ("Stops without a cause", "stops_without_cause", ""),
    ("Farthest that somebody was pushed back", "pushed_back", "m"),
    ("Delay against free flow", "free_flow_delay", "s"),
    ("Stops per km", "stops_per_km", ""),
    ("Traffic lights passed", "signals_passed", ""),
    ("Control delay, on average", "control_delay", "s"),
    ("of this level of service", "level_of_service", ""),
)
_OF_THE_PEOPLE = (  # metrics that are shown if there is a counterfactual run
    ("People's delay, all together", "people_delay", "s"),
    ("on average", "mean_people_delay", "s"),
    ("of one in twenty at least", "people_delay_95", "s"),
    ("of whom it cost most", "worst_people_delay", "s"),
    ("People who gave way, of those who crossed", "share_gave_way", "%"),
    ("Delay of background vehicles", "traffic_delay", "s"),
)
_OF_SUMO = (  # Metrics that are shown if plain SUMO drove as well
    ("Time of SUMO's own driver", "sumo_time", "s"),
    ("the ego's time over it", "time_over_sumo", ""),
    ("the same with its speedFactor at 1", "sumo_time_at_limit", "s"),
    ("the ego's time over it", "time_over_sumo_at_limit", ""),
)
_OF_WALKS = (  # Metrics that are shown if there is no ego
    ("Mean walking speed", "mean_walking_speed", "m/s"),
    ("Time slower than 0.2 m/s, on average", "mean_slow_time", "s"),
    ("Way, on average", "mean_walk", "m"),
)
_COUNTED = (
    ("Pedestrians added", "added"),
    ("Persons taken over from SUMO", "taken_over"),
    ("handed back", "handed_back"),
    ("arrived", "arrived"),
    ("gone on by vehicle, or to a stop", "continued"),
    ("still walking", "walking"),
)


def summary_table(result: RunResult) -> Table:
    """Return a table of the summary's most important numbers, with units.

    A missing number is shown as a dash.
    """
    names = [ego.id for ego in result.egos] or [""]
    table = Table(
        "",
        *(Column(Text(name), justify="right") for name in names),
        "",
        title=Text(_title(result)),
        show_header=len(result.egos) > 1,
        title_justify="left",
    )
    for label, name, unit in _shown(result):
        cells = [_formatted(ego.summary.get(name), unit) for ego in result.egos]
        table.add_row(label, *(value for value, _ in cells), max(unit for _, unit in cells))
    if result.walks is not None:
        for label, name, unit in _OF_WALKS:
            table.add_row(label, *_formatted(result.summary[name], unit))
    blanks = [""] * max(0, len(result.egos) - 1)
    for label, count in _counts(result):
        table.add_row(label, count, *blanks, "")
    factor, unit = _formatted(result.timing_summary["real_time_factor"], "x")
    table.add_row("Real-time factor", factor, *blanks, unit)
    if result.effect is not None:
        table.add_row("Computing time of the twin", f"{result.effect.seconds:.2f}", *blanks, "s")
    return table


def _shown(result: RunResult) -> Iterator[tuple[str, str, str]]:
    """Yield label, column and unit of each number that is shown of an ego."""
    if result.egos:
        yield from _SHOWN
    if any(ego.plain is not None for ego in result.egos):
        yield from _OF_SUMO
    if result.effect is not None:
        has_traffic = any(math.isfinite(ego.summary["traffic_delay"]) for ego in result.egos)
        yield from _OF_THE_PEOPLE if has_traffic else _OF_THE_PEOPLE[:-1]
    judged = [ego.summary for ego in result.egos if ego.ledger is not None]
    for label, name, unit in _OF_THE_LAW:
        always = name in {"encounters", "yielding_rate"}
        if any(always or _is_worth_showing(summary[name]) for summary in judged):
            yield label, name, unit
    for own in (column for ego in result.egos[:1] for column in ego.measured.columns):
        yield own.name + (f" ({own.unit})" if own.unit else ""), own.name, ""


def _title(result: RunResult) -> str:
    if len(result.egos) == 1:
        return f"{_run_title(result, result.egos[0])} - {result.ending}"
    egos = f"{len(result.egos)} egos" if result.egos else "no ego"
    pedestrians = len(result.crowd_track.ids)
    seed = result.config.seed
    return (
        f"{result.scenario.name}: {egos}, {pedestrians} pedestrians, seed {seed} - {result.ending}"
    )


def _run_title(result: RunResult, ego: EgoResult) -> str:
    pedestrians = len(result.crowd_track.ids)
    controller = ego.config.driver
    seed = result.config.seed
    return f"{result.scenario.name}: {controller}, {pedestrians} pedestrians, seed {seed}"


def _counts(result: RunResult) -> list[tuple[str, str]]:
    """Return the numbers of persons taken over from SUMO and of vehicles that yielded."""
    ledger: dict[str, Any] = result.manifest["pedestrians"]
    lines = []
    if ledger.get("taken_over"):
        lines += [(label, str(ledger[name])) for label, name in _COUNTED if ledger[name]]
    yielded = result.manifest["traffic"].get("vehicles_that_yielded", 0)
    if yielded:
        lines.append(("Background vehicles that yielded", str(yielded)))
    return lines


def _is_worth_showing(value: float | str) -> bool:
    return bool(value) if isinstance(value, str) else value > 0.0


def _formatted(value: float | str | None, unit: str) -> tuple[str, str]:
    if isinstance(value, str):
        return value, unit
    if value is None or not math.isfinite(value):
        return "-", ""
    if isinstance(value, int):
        return str(value), unit
    return (f"{100 * value:.1f}", unit) if unit == "%" else (f"{value:.2f}", unit)
