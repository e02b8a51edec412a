"""Red lights that the ego ran."""

from typing import NamedTuple

import numpy as np

from giveway.metrics.law.drive import Drive
from giveway.run_data.way import StopLine

RED = frozenset("rRu")
YELLOW = frozenset("yY")
ARROW = "s"
"""State of a green arrow beside red: a vehicle may turn after a stop."""

_STOPPED = 3.0  # [m] distance before the line within which a stop counts


class RedLight(NamedTuple):
    """A stop line that the ego passed although its light forbade it."""

    line: StopLine
    time: float  # [s] time at which the front passed the line
    letter: str
    # time since red [s], or deceleration [m/s^2] that would have been enough at yellow
    value: float


def red_lights(drive: Drive) -> list[RedLight]:
    """Return the red lights that the ego ran, in the order of its path.

    Args:
        drive: Drive of the ego.
    """
    found = []
    for line in drive.way.lines:
        time = drive.time_at(line.station)
        if not np.isfinite(time):
            continue
        letter = str(drive.letters(line.system, line.link, np.array([time]))[0])
        since = _since(drive, line, time)
        if letter in RED or (letter == ARROW and not _has_stopped(drive, line)):
            found.append(RedLight(line, time, letter, time - since))
        elif letter in YELLOW:
            k = int(drive.instants(np.array([since]))[0])
            room = line.station - drive.front[k]
            needed = float(drive.ego.speed[k] ** 2 / (2.0 * room)) if room > 0.0 else np.inf
            if needed <= drive.comfortable:
                found.append(RedLight(line, time, letter, needed))
    return found


def _since(drive: Drive, line: StopLine, time: float) -> float:
    """Return the time [s] since which the line's light has its colour of ``time`` [s]."""
    mine = drive.signals.system == line.system
    changes = drive.signals.time[mine]
    changes = changes[changes <= time + 1e-6]
    letters = drive.letters(line.system, line.link, changes)
    kinds = [_kind(letter) for letter in letters.tolist()]
    since = len(kinds) - 1
    while since > 0 and kinds[since - 1] == kinds[-1]:
        since -= 1
    return float(changes[since]) if kinds else float(drive.ego.time[0])


def _kind(letter: str) -> str:
    return "red" if letter in RED or letter == ARROW else letter.lower()


def _has_stopped(drive: Drive, line: StopLine) -> bool:
    near = (drive.front <= line.station) & (drive.front >= line.station - _STOPPED)
    return bool((drive.ego.speed[near] < drive.stop_speed).any())
