"""The heartbeat: the state of a run, which another process can read even after this one has died.

The heartbeat is 64 bytes of shared memory in a file: the child stores, and its supervisor reads. A
store costs no more than an assignment, so every phase of every control step is stored. This module
imports little, since the supervisor has to start at once.
"""

import enum
import mmap
import struct
from pathlib import Path
from typing import NamedTuple, Self

HEARTBEAT_FILE = "heartbeat"
_LAYOUT = struct.Struct("=8q")
PHASE, _STEP, _TIME, _CODE, _SUPERVISOR, _KEEP = range(6)  # indices of the used slots, int64 each
INSTANT = slice(_STEP, _TIME + 1)  # slots that are stored together: a kill leaves both or neither
MILLISECONDS = 1000.0  # milliseconds per second, which is SUMO's resolution


class Phase(enum.IntEnum):
    """The phases of a run."""

    STARTING = 0  # Python itself starts; this is the value before the first store
    LOADING = 1
    CONTROLLING = 2
    VEHICLE = 3
    CROWD = 4
    SUMO = 5
    MEASURING = 6
    WRITING = 7
    DONE = 8


SETTING_UP = 5.0
"""Factor on the time without progress that counts as a hang while a run is being set up.

A large network takes minutes to load.
"""
LOOP = frozenset({Phase.CONTROLLING, Phase.VEHICLE, Phase.CROWD, Phase.SUMO})
_PLACES = {
    Phase.STARTING: "while Python started",
    Phase.LOADING: "while the run was being set up",
    Phase.CONTROLLING: "in the controller at {time:.2f} s (step {step})",
    Phase.VEHICLE: "in the vehicle FMU's step from {time:.2f} s (step {step})",
    Phase.CROWD: "in the crowd's step from {time:.2f} s (step {step})",
    Phase.SUMO: "inside SUMO's step from {time:.2f} s (step {step})",
    Phase.MEASURING: "while the run's numbers were being worked out",
    Phase.WRITING: "while the results were being written",
    Phase.DONE: "after everything had been done",
}


class Pulse(NamedTuple):
    """The content of a heartbeat at one reading."""

    phase: Phase
    step: int  # control step
    time: float  # [s] on SUMO's clock
    code: int  # exit code, if the phase is DONE
    supervisor: int  # process id, or 0 without one

    @property
    def place(self) -> str:
        """Return the phase in words that continue a sentence."""
        return _PLACES[self.phase].format(time=self.time, step=self.step)


class Heartbeat:
    """The shared memory of a child, which stores, and of its supervisor, which reads.

    Args:
        folder: Folder of the journal; the file is made if it does not exist. With None the memory
            is only this process's.

    Attributes:
        slots: Slots of the memory, one int64 each. The loop stores into ``slots[PHASE]`` and
            ``slots[INSTANT]`` itself.
        instant: Buffer of step and time, before they are stored.

    Raises:
        OSError: the file cannot be made or mapped.
    """

    slots: memoryview
    instant: memoryview

    def __init__(self, folder: Path | None) -> None:
        self.instant = memoryview(bytearray(16)).cast("q")  # step and time, before they are stored
        if folder is None:
            self.slots = memoryview(bytearray(_LAYOUT.size)).cast("q")
            return
        path = folder / HEARTBEAT_FILE
        # Zeros are written, since a store into a hole of a file on a full disk would end the
        # process.
        with path.open("r+b" if path.exists() else "w+b", buffering=0) as file:
            if len(file.read()) < _LAYOUT.size:
                file.seek(0)
                file.write(bytes(_LAYOUT.size))
            self.slots = memoryview(mmap.mmap(file.fileno(), _LAYOUT.size)).cast("q")

    @classmethod
    def supervised_by(cls, process_id: int, folder: Path) -> Self:
        """Return a new heartbeat that names its supervisor."""
        heartbeat = cls(folder)
        heartbeat.slots[_SUPERVISOR] = process_id
        return heartbeat

    def beat(self, phase: int) -> None:
        """Store the phase that begins."""
        self.slots[PHASE] = phase

    def step(self, step: int, time: float) -> None:
        """Store the control step that begins, and its time [s] on SUMO's clock."""
        instant = self.instant
        instant[0], instant[1] = step, round(time * MILLISECONDS)
        self.slots[INSTANT] = instant

    def finish(self, code: int) -> None:
        """Store the exit code and the regular end; an end without this is a crash."""
        self.slots[_CODE] = code
        self.slots[PHASE] = Phase.DONE

    def keep(self) -> None:
        """Ask the supervisor to keep the journal, whose rows have not been written elsewhere."""
        self.slots[_KEEP] = 1

    @property
    def kept(self) -> bool:
        """Return whether the journal is to be kept."""
        return bool(self.slots[_KEEP])

    def read(self) -> Pulse:
        """Return the latest state."""
        phase, step, time, code, supervisor = self.slots[: _SUPERVISOR + 1].tolist()
        # a wild pointer may have overwritten it
        known = Phase(phase) if phase in _PLACES else Phase.LOADING
        return Pulse(known, step, time / MILLISECONDS, code, supervisor)


class Stillness:
    """The time without a change of a heartbeat, which a supervisor reads from time to time.

    The times between readings are added up, since the clock goes on while both processes are
    suspended.

    Args:
        heartbeat: Heartbeat to read.
    """

    def __init__(self, heartbeat: Heartbeat) -> None:
        self._heartbeat = heartbeat
        self._last = heartbeat.read()
        self._quiet = 0.0

    def look(self, passed: float) -> tuple[Pulse, float]:
        """Return the pulse, and the time [s] for which it has not changed.

        Args:
            passed: Time [s] since the last call.
        """
        pulse = self._heartbeat.read()
        self._quiet = self._quiet + passed if pulse == self._last else 0.0
        self._last = pulse
        return pulse, self._quiet
