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
        None, None, "the ego stops at red lights. Left out: it does"
    )
    signal_advice: bool | None = option(
        None,
        None,
        "lights tell the ego their plan (SPaT): it waits for nobody who will find theirs red, and "
        "mpc arrives when its own is green. Left out: they do",
    )
    stops: bool | None = option(
        None,
        None,
        "an ego that is taken over serves its scheduled stops. Left out: if it is a bus, a coach "
        "or a tram",
    )
    crossings: bool | None = option(
        None,
        None,
        "the ego gives way to people at crossings, and they rely on it. Left out: it does, but "
        "not with the paper's controllers",
    )
    right_of_way: bool | None = option(
        None,
        None,
        "the ego gives way to vehicles at junctions by the network's priority. Left out: it does, "
        "but not with the paper's controllers",
    )
    merging: bool | None = option(
        None,
        None,
        "the ego and others come one behind the other where lanes become one. Left out: they do, "
        "but not with the paper's controllers",
    )
    following: bool | None = option(
        None, None, "the ego keeps its distance to vehicles in front. Left out: it does"
    )
    speed_limits: bool | None = option(
        None,
        None,
        "limits of lanes and comfort in bends cap the speed. Left out: if [regulation] "
        "reference_speed is 'lane'",
    )
