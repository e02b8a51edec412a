"""The twin of a run: the same again, but people do not feel the egos.

The egos are there for SUMO, as they drove in the run: the zone, the lights, the background vehicles
and all that is drawn are the same. What differs is what the egos cost the people.

On open ground, where nobody else ever is, that is the crowd among itself. It depends on no ego, so
that the runs that one process makes with the same people share it.
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
from giveway.config.files.presets import parameters_of
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

_KEPT = 8  # crowds among themselves that a process remembers
_alone: OrderedDict[bytes, CrowdAlone] = OrderedDict()


@dataclass(frozen=True)
class Twin:
    """The fate of the people in the counterfactual run.

    Attributes:
        walks: how they got on, up to the control step at which following ends.
        traffic_differs: whether lights or background vehicles did anything else than in the run.
        traffic_delay: [s] that the background vehicles lost until the last ego's arrival, less what
            they lose until then where the egos are not there at all; nan: there are none, or an ego
            is one of the scenario's.
        among_themselves: it is the crowd on open ground, without SUMO.
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
    """Go through a run again; SUMO must be free.

    Args:
        checked: The run.
        followed: how its people got on.
        driven: how its egos drove.
        heartbeat: Function that tells another process that this one is alive.
        interrupt: Flag that is read between two steps.
        native_log: File for what SUMO prints; None: a temporary one.

    Returns:
        The twin; None: it was interrupted.

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
    """Repeat a run up to the control step ``last``; None if it was interrupted."""
    with ExitStack() as stack:
        parts = assemble(checked, stack, native_log=native_log, driven=driven)
        log = None if driven.absent else walks  # nobody asks how people got on without egos
        walking = Walking(checked.config, parts.crowd_model, parts.roster, log)
        traffic = TrafficNotes(parts.sumo)
        absent = driven if driven.absent else None
        loop = ReplayedLoop(parts, walking, walks, traffic, heartbeat, driven=absent)
        ended = loop.run(last, interrupt, to_the_end=driven.absent)
    return traffic if ended else None


def _crowd_alone(config: RunConfig, beginning: Beginning, time_step: float) -> CrowdAlone:
    """The crowd of a run among itself, as far as it has been asked for already."""
    key = _key(config, beginning, time_step)
    if key in _alone:
        _alone.move_to_end(key)
        return _alone[key]
    roster = Roster(beginning.names, beginning.crowd.copy(), beginning.traits)
    walks = WalkLog(time_step, lambda _: True)
    walking = Walking(config, model_of(config, time_step, roster), roster, walks)
    flows = None if beginning.flows is None else beginning.flows.afresh(roster)
    alone = CrowdAlone(roster, walking, walks, 0, flows, beginning.substeps)
    _alone[key] = alone
    if len(_alone) > _KEPT:
        _alone.popitem(last=False)
    return alone


def _key(config: RunConfig, beginning: Beginning, time_step: float) -> bytes:
    """A hash of all that the crowd among itself depends on."""
    digest = hashlib.sha256()
    settings, crowd = config.crowd, beginning.crowd
    noise = settings.acceleration_noise
    drawn = (settings, config.seed, beginning.substeps) if settings.flow else None
    for part in (
        parameters_of(settings.preset),
        (
            settings.model,
            sorted(code_hashes(config, (MODEL,)).items()),
            sorted(config.model_options.items()),
            config.seed if settings.plugged_in else None,
            settings.detour,
            settings.creep,
            time_step,
            noise,
            config.seed if noise else None,
        ),
        beginning.names,
        sorted(beginning.traits.items()),
        drawn,
    ):
        digest.update(repr(part).encode())
    for array in (*crowd.state, *crowd.fixed_arrays):
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.digest()
