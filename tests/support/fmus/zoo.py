"""The builder: ``zoo.car(...)`` writes an FMU and its profile, and returns the FMU's path."""

from __future__ import annotations

import copy
import functools
import subprocess
import sys
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import tomlkit

from fmus.archive.packing import write_archive
from support.fmus import compiling
from support.fmus.cars import Car, Fault, profile, settings
from support.fmus.description import IDENTIFIER, describe
from support.fmus.faults import FAULTS

if TYPE_CHECKING:
    from collections.abc import Sequence

PYTHON: Final = Path(__file__).parent / "python"
OLD_FOLDERS: Final = {  # of FMI 1 and 2, by that of FMI 3
    "x86_64-linux": "linux64",
    "aarch64-linux": "aarch64-linux",
    "x86_64-windows": "win64",
    "x86_64-darwin": "darwin64",
    "aarch64-darwin": "darwin64",
}


class Zoo:
    """Builds FMUs into a folder; the same car is built once.

    Args:
        folder: of the FMUs; each has a folder of its own.
        cache: of the compiled libraries; may be shared by processes and sessions.
    """

    def __init__(self, folder: Path, cache: Path) -> None:
        self._folder = folder
        self._library = functools.cache(lambda fmi: compiling.library(fmi, cache))
        self._built: dict[str, Path] = {}
        self._cars: dict[Path, Car] = {}

    def car(
        self,
        *,
        behaviour: str | Sequence[str | Fault] = (),
        phase: str = "step",
        at: float = 0.2,
        file: str | None = None,
        **options: Any,
    ) -> Path:
        """Build a car.

        Args:
            behaviour: what it does wrong, of FAULTS; several of them in a list.
            phase: where, of PHASES.
            at: from when on [s].
            file: its name without ``.fmu``; by default it tells version, role and behaviour.
            options: the attributes of :class:`Car`.

        Returns:
            The path of the FMU; its profile is beside it, with the suffix ``.toml``.
        """
        names = [behaviour] if isinstance(behaviour, str) else behaviour
        faults = tuple(n if isinstance(n, Fault) else Fault(n, phase, at) for n in names)
        unknown = [fault.name for fault in faults if fault.name not in FAULTS]
        if unknown:
            msg = f"{unknown[0]}: no fault of the zoo; README.md lists them"
            raise ValueError(msg)
        car = Car(faults=faults, **options)
        if file is None:
            what = faults[0].name if faults else car.role
            file = f"fmi{car.fmi[0]}_{what}"
        key = f"{file} {car}"
        if key not in self._built:
            self._built[key] = self._write(car, file)
        return self._built[key]

    def python_car(self, fmi: str) -> Path:
        """The car of python/fmi2_car.py (PythonFMU) or python/fmi3_car.py (PythonFMU3).

        It has the parameters ``mass``, ``friction`` and ``v0``; FMI 2.0: no units, and a parameter
        ``broken`` with which it raises an exception at 0.2 s; FMI 3.0: kN and km/h.
        """
        return self._python(fmi, "car")

    def python_controller(self, fmi: str) -> Path:
        """The controller of python/fmi2_controller.py or python/fmi3_controller.py."""
        return self._python(fmi, "controller")

    def hill_car(self) -> Path:
        """The car of python/fmi3_hill_car.py, which feels the road's grade."""
        return self._python("3.0", "hill_car")

    def _python(self, fmi: str, what: str) -> Path:
        key = f"python {what} {fmi}"
        if key not in self._built:
            packer = {"2.0": "pythonfmu", "3.0": "pythonfmu3"}[fmi]
            source = PYTHON / f"fmi{fmi[0]}_{what}.py"
            folder = self._folder / f"{packer}_{what}"
            subprocess.run(
                [sys.executable, "-m", packer, "build", "-f", str(source), "-d", str(folder)],
                check=True,
                capture_output=True,
            )
            (self._built[key],) = folder.glob("*.fmu")
        return self._built[key]

    def profile(self, path: Path) -> dict[str, Any]:
        """A car's profile as nested dictionaries, for the caller to change."""
        return copy.deepcopy(profile(self._cars[path]))

    def members(self, car: Car, path: Path) -> dict[str, bytes]:
        """The files of an FMU that is to be at ``path``."""
        calls = str(path.with_suffix(".calls"))
        token = f"{{{uuid.uuid5(uuid.NAMESPACE_OID, settings(car, '', calls))}}}"
        expected = "{another-model}" if car.wrong_token else token
        library = self._library(car.fmi)
        for function in car.without:
            library = compiling.without(library, function)
        target = compiling.here()
        folder = target.folder if car.fmi == "3.0" else OLD_FOLDERS[target.folder]
        return {
            "modelDescription.xml": describe(car, token),
            f"binaries/{folder}/{IDENTIFIER}{target.suffix}": library,
            "resources/car.txt": settings(car, expected, calls).encode(),
        }

    def _write(self, car: Car, file: str) -> Path:
        folder = self._folder / str(len(self._built))
        folder.mkdir()
        path = folder / f"{file}.fmu"
        write_archive(path, self.members(car, path))
        path.with_suffix(".toml").write_text(tomlkit.dumps(profile(car)), encoding="utf-8")
        self._cars[path] = car
        return path
