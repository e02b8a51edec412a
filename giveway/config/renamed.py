"""Keys and flags that no longer exist, each with what to write instead."""

from collections.abc import Iterator, Mapping
from typing import Any, Final

Location = tuple[str, ...]

RENAMED: Final[Mapping[Location, Location | str]] = {
    ("mpc", "force_limit"): ("vehicle", "force_limit"),
    ("mpc", "force_rate_limit"): ("vehicle", "force_rate_limit"),
    ("mpc", "speed_max"): ("vehicle", "speed_max"),
    ("mpc", "solver"): "leave it out: the solver is always OSQP",
    ("safety", "margin"): "leave it out: it is always 0.05 m",
    ("safety", "rate_limited"): "leave it out: the layer's braking is never rate-limited",
    ("traffic", "yield_distance"): "leave it out: it is always 2 m",
    ("crowd", "zone_margin"): "leave it out: it is always 5 m",
    ("planner", "attitude"): ("controller_options", "style"),
    ("mpc", "horizon"): ("controller_options", "horizon"),
    ("mpc", "speed_min"): "leave it out: it is always 0 m/s",
    **{
        ("pid", key): ("controller_options", key)
        for key in ("proportional_gain", "integral_gain", "derivative_gain", "buffer_distance")
    },
    **{
        ("regulation", key): "for the paper's controllers write [controller_options] "
        f"{key} (--set {key}=VALUE); leave it out for the others"
        for key in ("gap_from", "corridor_half_width")
    },
    **{
        ("planner", key): "leave it out: it is always on"
        for key in ("gap_choice", "soft", "planned_speed", "belief", "contingency")
    },
    **{
        ("tuned_pid", key): ("controller_options", key)
        for key in (
            "profile",
            "buffer_distance",
            "deceleration",
            "approach_lag",
            "acceleration",
            "jerk",
            "firm_deceleration",
            "last_distance",
            "bandwidth",
            "damping",
            "acceleration_feed_forward",
        )
    },
    **{
        ("planner", key): ("controller_options", key)
        for key in (
            "horizon",
            "style",
            "effort_weight",
            "jerk_weight",
            "threat_weight",
            "later_weight",
            "minimum_distance",
            "deceleration",
            "calm_time",
        )
    },
    ("regulation", "comfortable_deceleration"): "leave it out: it is always 2 m/s^2",
    ("regulation", "kerb_distance"): "leave it out: it is always 1.5 m",
    ("regulation", "kerb_time"): "leave it out: it is always 2.5 s",
    ("regulation", "follow_up_gap"): "leave it out: it is the Highway Capacity Manual's",
    ("crowd", "desired_speed_min"): "leave it out: it is always 0.5 m/s",
    ("crowd", "desired_speed_max"): "leave it out: it is always 2.2 m/s",
    ("crowd", "acceleration_noise"): "write a preset file with base = 'SIM' and [parameters] sway "
    "[m/s^2] and sway_time [s] (--crowd-preset FILE)",
    ("crowd", "detour"): ("model_options", "detour"),
    ("crowd", "creep"): ("model_options", "creep"),
    ("vehicle", "exact"): "for true write [vehicle] fmu = 'fmi2-exact' (--vehicle fmi2-exact)",
    ("safety", "reaction_time"): "leave it out: it is what the vehicle's profile identified",
    ("sumo", "end"): "write [sumo] options = '--end SECONDS' (--sumo-options '--end SECONDS')",
    **{
        ("sumo", name): f"write [sumo] outputs = ['{name}'] (--sumo-outputs {name})"
        for name in ("fcd", "tripinfo", "ssm", "summary")
    },
    ("regulation", "traffic_lights"): ("rules", "traffic_lights"),
    ("regulation", "vehicles"): ("rules", "following"),
    ("regulation", "priority"): "write [rules] crossings, right_of_way and merging, true or false "
    "(--no-rules-crossings, ...)",
    ("ego", "keep_stops"): ("rules", "stops"),
    ("perception", "signal_plans"): ("rules", "signal_plans"),
    ("rules", "signal_advice"): "leave it out: advice on the speed saved no time",
    ("planner", "terminal"): "leave it out: it is always off",
    ("planner", "block_growth"): "leave it out: it is always 0.25",
    **{
        (table, name): "write [controller_options] precaution_weight (--set precaution_weight=5), "
        "or leave it out"
        for table in ("planner", "controller_options")
        for name in ("conflict_weight", "nearness_weight")
    },
}
"""Each refused key: the key to write instead, or a sentence that says what to do."""

FLAGS: Final[Mapping[str, Location]] = {
    "attitude": ("planner", "attitude"),
    "fcd": ("sumo", "fcd"),
    "tripinfo": ("sumo", "tripinfo"),
    "ssm": ("sumo", "ssm"),
    "kerb-distance": ("regulation", "kerb_distance"),
    "kerb-time": ("regulation", "kerb_time"),
    "follow-up-gap": ("regulation", "follow_up_gap"),
    "obey-lights": ("regulation", "traffic_lights"),
    "respect-vehicles": ("regulation", "vehicles"),
    "priority": ("regulation", "priority"),
    "signal-plans": ("perception", "signal_plans"),
}
"""Removed flags, without dashes, that were not derived from their keys in ``RENAMED``."""


_OWN_FLAGS: Final[Mapping[Location, str]] = {("controller_options", "style"): "--style"}

GONE_FLAGS: Final[Mapping[str, str]] = {
    "aim": "leave it out: a fit is for behaviour; [perception] model = 'drift' predicts better than"
    " a fit for displacement did",
    "held-out": "leave it out: judge a fit on another site (giveway data behave)",
    "regulation-reference-speed": "write --desired-speed",
    "own-pace": "leave it out: people's desired speeds are those that they show",
}
"""Removed flags that were never keys, each with what to do instead."""


def renamed_in(values: Mapping[str, Any]) -> Iterator[tuple[Location, Location | str]]:
    """Yield each removed key in the settings or in a table of ``[[egos]]``, and its replacement.

    Args:
        values: Settings of one file or of the command line.
    """
    egos = values.get("egos")
    for old, new in RENAMED.items():
        for table in (values, *(egos if isinstance(egos, list | tuple) else ())):
            if _holds(table, old):
                yield old, new


def advice(new: Location | str, *, as_flag: bool) -> str:
    """Return what to write instead of a key that no longer exists, for a file or as a flag."""
    if isinstance(new, str):
        return new
    if as_flag and new in _OWN_FLAGS:
        return f"write {_OWN_FLAGS[new]}"
    if new[0].endswith("_options"):
        setting = "--set" if new[0] == "controller_options" else "--set-model"
        return f"write {setting} {new[-1]}=VALUE" if as_flag else f"write [{new[0]}] {new[-1]}"
    if as_flag:
        return f"write --{'-'.join(new).replace('_', '-')}"
    *tables, key = new
    return f"write [{'.'.join(tables)}] {key}" if tables else f"write {key}"


def renamed_flag(word: str) -> str | None:
    """Return what to write instead of a removed flag, or None if the word is not one."""
    name = word.partition("=")[0].removeprefix("--")
    positive = name.removeprefix("no-")
    derived = {"-".join(old).replace("_", "-"): old for old in RENAMED} | dict(FLAGS)
    if positive in GONE_FLAGS:
        return GONE_FLAGS[positive]
    if positive not in derived:
        return None
    said = advice(RENAMED[derived[positive]], as_flag=True)
    if name == positive:
        return said
    if said.endswith("=VALUE"):
        return said.removesuffix("VALUE") + "false"
    return said.replace("write --", "write --no-", 1)


def _holds(values: Any, location: Location) -> bool:
    for key in location:
        if not isinstance(values, Mapping) or key not in values:
            return False
        values = values[key]
    return True
