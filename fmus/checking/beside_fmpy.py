"""The same drive by giveway and by FMPy: the same inputs must give the same motion.

Both drives run in a process of their own, so that whatever the FMU does there ends with it.
"""

import json
import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fmus.archive.own_folder import OwnFolder
from fmus.archive.place import unpacking_place
from fmus.driving.starting import start_values
from fmus.driving.vehicle import VehicleFmu
from fmus.errors import FmuError
from fmus.profile.preparation import Prepared, unpack
from fmus.text import printable

TIMEOUT = 120.0  # [s] of wall-clock time for both drives


@dataclass(frozen=True)
class Beside:
    """The largest differences of two drives with the same inputs.

    Attributes:
        fmpy: Version of FMPy; empty if it was not run.
        duration: Duration of the drives [s].
        speed: Largest difference of the speeds [m/s].
        position: Largest difference of the positions [m], or None if the FMU gives none.
        problem: Reason why there is no comparison; empty if there is one.
    """

    fmpy: str = ""
    duration: float = 0.0
    speed: float = 0.0
    position: float | None = None
    problem: str = ""


def beside_fmpy(prepared: Prepared, forces: Sequence[float]) -> Beside:
    """Drive an FMU from rest by giveway and then by FMPy with the inputs of that drive.

    Args:
        prepared: Prepared vehicle.
        forces: Force [N] of each control step.
    """
    wiring = prepared.wiring
    if prepared.model.system is not None:
        return Beside(problem="FMPy drives one FMU")
    used = [*wiring.read[: len(wiring.outputs)], *(wire.channel for wire in wiring.inputs)]
    if any(len(c.parts) > 1 or not c.variable.scalar for c in used):
        return Beside(problem="FMPy takes no single elements of arrays, and no shares or means")
    if prepared.clocks:
        return Beside(problem="FMPy does not tick input clocks")
    with OwnFolder("beside-fmpy-", unpacking_place()) as scratch:
        folder = Path(scratch)
        (folder / "order").write_bytes(pickle.dumps((prepared, prepared.path.resolve(), forces)))
        try:
            unpack(prepared, folder / "fmu")
            ended = subprocess.run(
                [sys.executable, "-P", "-m", __name__, str(folder)],
                cwd=folder,
                env=os.environ | {"TMPDIR": scratch, "PYTHONPATH": os.pathsep.join(sys.path)},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=TIMEOUT,
                check=False,
            )
            return Beside(**json.loads((folder / "answer").read_text("utf-8")))
        except subprocess.TimeoutExpired:
            return Beside(problem=f"FMPy's drive has not ended within {TIMEOUT:g} s")
        except FmuError as error:
            return Beside(problem=printable(error))
        except (OSError, ValueError):
            return Beside(problem=f"the process of FMPy's drive ended with {ended.returncode}")


class _Logged(VehicleFmu):
    """A vehicle that keeps the raw inputs and outputs of each of its FMU's steps."""

    def log(self) -> list[tuple[list[float], list[float]]]:
        """Return the list that the steps from now on fill."""
        rows: list[tuple[list[float], list[float]]] = []
        tick = self._tick

        def logged(time: float, step: float) -> int:
            given = list(self._inputs)
            status = tick(time, step)
            rows.append((given, list(self._outputs)))
            return status

        self._tick = logged
        return rows


def compared(prepared: Prepared, path: Path, folder: Path, forces: Sequence[float]) -> Beside:
    """Return the differences; both drives run in this process.

    Args:
        prepared: Prepared vehicle.
        path: Absolute path of the FMU.
        folder: Folder of the unpacked FMU.
        forces: Force [N] of each control step.

    Raises:
        FmuError: giveway's drive fails.
    """
    from fmus.fmi import by_fmpy  # other processes need no FMPy here

    wiring, step = prepared.wiring, prepared.step_plan.step
    with _Logged.unpacked(prepared, folder) as car:
        car.start()
        rows = car.log()
        for force in forces:
            car.step(force)
    given = np.array([row[0] for row in rows])
    ours = np.array([row[1] for row in rows])
    theirs = by_fmpy.simulate(
        path,
        wiring.interface,
        prepared.profile.fmu,
        {channel.name: value for channel, value in start_values(prepared, 0.0, 0.0).items()},
        {wire.channel.name: given[:, i] for i, wire in enumerate(wiring.inputs)},
        [wire.channel.name for wire in wiring.outputs],
        step,
    )[1:]
    apart = {
        wire.role: float(np.abs(wire.scale * (theirs[:, i] - ours[:, i])).max())
        for i, wire in enumerate(wiring.outputs)
    }
    return Beside(by_fmpy.VERSION, len(rows) * step, apart["speed"], apart.get("position"))


def main(folder: Path) -> None:
    """Carry out the order in a folder, and write the answer there."""
    prepared, path, forces = pickle.loads((folder / "order").read_bytes())
    try:
        answer = compared(prepared, path, folder / "fmu", forces)
    except Exception as error:  # whatever FMPy or the FMU raises is the answer
        answer = Beside(problem=f"{type(error).__name__}: {printable(error, 300)}")
    (folder / "answer").write_text(json.dumps(vars(answer)), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
