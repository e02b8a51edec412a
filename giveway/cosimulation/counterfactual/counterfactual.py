"""The counterfactual run: the same run again, but people do not feel the egos.

The egos are there for SUMO, and drive as they did in the run. The zone, the traffic lights, the
background vehicles and all random draws are the same. The difference is what the egos cost the
people.

On open ground there is nobody else, and the counterfactual run is the added crowd alone. It depends
on no ego, so runs of one process with the same people share it.
"""

import hashlib
import math
from collections import OrderedDict
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from giveway.config import RunConfig
from giveway.config.files.foreign_code import code_hashes
from giveway.config.files.presets import crowd_of
from giveway.cosimulation.assembly import Driven, assemble
from giveway.cosimulation.counterfactual.crowd_alone import CrowdAlone
from giveway.cosimulation.counterfactual.follow_up import Beginning, Followed
from giveway.cosimulation.counterfactual.replayed_loop import ReplayedLoop
from giveway.cosimulation.preflight import CheckedRun
from giveway.cosimulation.traffic.traffic_log import TrafficNotes
from giveway.crowd.models import model_of
from giveway.crowd.roster import Roster, Walking
from giveway.journal.walk_log import WalkLog
from giveway.plug_ins.sockets import MODEL
from giveway.processes.heartbeat import Heartbeat
from giveway.processes.interrupts import DeferredInterrupt
from giveway.run_data.walks import WalkTrack

_KEPT = 8  # Number of crowds without egos that a process remembers
_alone: OrderedDict[bytes, CrowdAlone] = OrderedDict()


@dataclass(frozen=True)
class Twin:
    """The people's walks in the counterfactual run.

    Attributes:
        walks: Tracks of the people, up to the control step at which the follow-up ends.
        traffic_differs: True if lights or background vehicles behaved differently from the run.
        traffic_delay: Time [s] that the background vehicles lost until the last ego's arrival, less
            the time that they lose in a run without the egos. nan if there are no background
            vehicles, or if an ego is a vehicle of the scenario.
        among_themselves: True if the run is the crowd on open ground, without SUMO.
    """

    walks: WalkTrack
    traffic_differs: bool
    traffic_delay: float
    among_themselves: bool


def twin_of(
    checked: CheckedRun,
    followed: Followed,
    driven: Driven,
    heartbeat: Heartbeat,
    interrupt: DeferredInterrupt,
    native_log: Path | None = None,
) -> Twin | None:
    """Repeat a run without the egos' influence on people; no other simulation may be open in SUMO.

    Args:
        checked: Checked configuration of the run.
        followed: Notes of the run about its people and traffic.
        driven: Recorded drives of its egos.
        heartbeat: Function that tells another process that this one is alive.
        interrupt: Flag that is read between two steps.
        native_log: File for what SUMO prints, or None for a temporary one.

    Returns:
        The counterfactual run, or None if it was interrupted.

    Raises:
        GivewayError: a part failed.
    """
    names, last = followed.walks.near, followed.last
    if followed.secluded:
        alone = _crowd_alone(checked.config, followed.beginning, checked.time_step)
        alone.go_on(last, names, heartbeat)
        return Twin(alone.walks.track.until(last), False, math.nan, among_themselves=True)
    walks = WalkLog(checked.time_step, names.__contains__)
    again = partial(_again, checked, heartbeat=heartbeat, native_log=native_log)
    traffic = again(walks, driven, last, interrupt)
    if traffic is None:
        return None
    delay = math.nan
    if followed.traffic.vehicles and not any(ego.ego.take_over for ego in checked.egos):
        absent = driven._replace(absent=True)
        alone_there = again(WalkLog(checked.time_step), absent, followed.arrival, interrupt)
        if alone_there is None:
            return None
        delay = followed.time_loss - alone_there.time_loss
    differs = traffic.differ_from(followed.traffic)
    return Twin(walks.track, differs, delay, among_themselves=False)


def _again(
    checked: CheckedRun,
    walks: WalkLog,
    driven: Driven,
    last: int,
    interrupt: DeferredInterrupt,
    *,
    heartbeat: Heartbeat,
    native_log: Path | None,
) -> TrafficNotes | None:
    """Repeat a run up to the control step ``last``; return None if it was interrupted."""
    with ExitStack() as stack:
        parts = assemble(checked, stack, native_log=native_log, driven=driven)
        log = None if driven.absent else walks  # without egos, nobody's walk is needed
        walking = Walking(checked.config, parts.crowd_model, parts.roster, log)
        traffic = TrafficNotes(parts.sumo)
        absent = driven if driven.absent else None
        loop = ReplayedLoop(parts, walking, walks, traffic, heartbeat, driven=absent)
        ended = loop.run(last, interrupt, to_the_end=driven.absent)
    return traffic if ended else None


def _crowd_alone(config: RunConfig, beginning: Beginning, time_step: float) -> CrowdAlone:
    """The crowd of a run without egos, stepped as far as any earlier call needed it."""
    key = _key(config, beginning, time_step)
    if key in _alone:
        _alone.move_to_end(key)
        return _alone[key]
    roster = Roster(beginning.names, beginning.crowd.copy(), beginning.traits)
    walks = WalkLog(time_step, lambda _: True)
    walking = Walking(config, model_of(config, time_step, roster), roster, walks)
    sources = None if beginning.sources is None else beginning.sources.afresh(roster)
    alone = CrowdAlone(roster, walking, walks, 0, sources, beginning.substeps)
    _alone[key] = alone
    if len(_alone) > _KEPT:
        _alone.popitem(last=False)
    return alone


def _key(config: RunConfig, beginning: Beginning, time_step: float) -> bytes:
    """A hash of all that a crowd without egos depends on."""
    digest = hashlib.sha256()
    settings, crowd = config.crowd, beginning.crowd
    parameters = crowd_of(config)
    come_in = settings.flow or settings.recorded
    drawn = (settings, config.seed, beginning.substeps) if come_in else None
    for part in (
        parameters,
        (
            settings.model,
            sorted(code_hashes(config, (MODEL,)).items()),
            sorted(config.model_options.items()),
            config.seed if settings.plugged_in or parameters.sway else None,
            time_step,
        ),
        beginning.names,
        sorted(beginning.traits.items()),
        drawn,
    ):
        digest.update(repr(part).encode())
    if beginning.sources is not None:
        digest.update(beginning.sources.identity)
    for array in (*crowd.state, *crowd.fixed_arrays):
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.digest()
