"""The table `[rules]`: which rules of the road an ego heeds, each by its registered name."""

from typing import ClassVar

from giveway.config.option import option
from giveway.config.tables.plug_in_table import PlugInTable
from giveway.plug_ins.sockets import RULE, Socket

OF_PRIORITY = frozenset({"crossings", "right_of_way", "merging"})
"""The rules of priority; by default they hold if the controller's declaration says so."""


class RulesConfig(PlugInTable):
    """The rules of the road that the ego heeds; its controller decides on one that is left out."""

    socket: ClassVar[Socket] = RULE

    traffic_lights: bool | None = option(
        None, None, "The ego stops at red lights. It does by default"
    )
    signal_plans: bool | None = option(
        None,
        None,
        "Walkers' lights tell the ego when they change. The ego waits for nobody who will find "
        "theirs red, and knows when people at the kerb may start. They do by default",
    )
    stops: bool | None = option(
        None,
        None,
        "An ego that is taken over serves its scheduled stops. By default a bus, a coach or a "
        "tram does",
    )
    crossings: bool | None = option(
        None,
        None,
        "The ego gives way to people at crossings, and they rely on it. It does by default, but "
        "not with the paper's controllers",
    )
    right_of_way: bool | None = option(
        None,
        None,
        "The ego gives way to vehicles at junctions by the network's priority. It does by "
        "default, but not with the paper's controllers",
    )
    merging: bool | None = option(
        None,
        None,
        "The ego and other vehicles merge in turn where lanes become one. They do by default, but"
        " not with the paper's controllers",
    )
    following: bool | None = option(
        None, None, "The ego keeps its distance to vehicles in front. It does by default"
    )
    hidden_people: bool | None = option(
        None,
        None,
        "The ego slows down before places where people could come out of hiding. It does by "
        "default if its sensor tells what it does not see",
    )
    speed_limits: bool | None = option(
        None,
        None,
        "Limits of lanes and comfort in bends cap the speed. They do by default if [regulation] "
        "reference_speed is 'lane'",
    )
