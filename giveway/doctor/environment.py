"""The check of the installation: versions, SUMO, FMU, solver, compiler, folders, terminal."""

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any, cast

import numpy as np
from packaging.requirements import InvalidRequirement, Requirement

from controller import ControllerError, LongitudinalModel, Mpc, MpcParameters
from fmus import FmuError, VehicleFmu, bundled_fmu
from giveway._start.environment import check_rooms
from giveway.doctor.finding import Finding, error, note, ok, warning
from giveway.errors import InstallationError

_ENOUGH_SPACE = 1e9  # [bytes] space for the results of a study
_OLDEST_PYTHON = (3, 11)
_PATIENCE = 60.0  # Time limit [s] of a child process
_CHARACTERS = "Özgüner – m/s² ± µs"  # characters that our summaries print
_IMPORT_SUMO = "from giveway.sumo.library import version; print(version())"


def examine_environment(results: Path = Path("results")) -> list[Finding]:
    """Check everything that a run needs besides its scenario.

    Args:
        results: Folder for results.
    """
    examinations: tuple[Callable[[], list[Finding]], ...] = (
        _python,
        _rooms,
        _packages,
        _sumo,
        _vehicle,
        _kernels,  # before any is loaded, which mends damaged files
        _solver,
        lambda: _folder("temporary folder", Path(tempfile.gettempdir()), "set TMPDIR"),
        lambda: _folder("results folder", results.absolute(), "name another with --out"),
        _terminal,
    )
    return [finding for examine in examinations for finding in examine()]


def _python() -> list[Finding]:
    version = sys.version.split()[0]
    if sys.version_info < _OLDEST_PYTHON:
        return [error("Python", version, "install Python 3.11 or later")]
    return [ok("Python", f"{version} on {sys.platform}")]


def _rooms() -> list[Finding]:
    try:
        check_rooms()
    except InstallationError as problem:
        return [error("giveway", str(problem), "use a virtual environment of its own")]
    return []


def _packages() -> list[Finding]:
    """Compare every package that giveway needs with the versions that it declares."""
    findings = []
    for requirement in _requirements():
        subject = requirement.name
        try:
            version = metadata.version(subject)
        except metadata.PackageNotFoundError:
            install = f"pip install '{requirement.name}{requirement.specifier}'"
            findings.append(error(subject, "not installed", install))
            continue
        if requirement.specifier.contains(version, prereleases=True):
            findings.append(ok(subject, version))
            continue
        text = f"{version}; giveway was built for {requirement.specifier}"
        remedy = f"pip install '{requirement.name}{requirement.specifier}'"
        findings.append(warning(subject, text, remedy))
    return findings


def _requirements() -> list[Requirement]:
    """Return the requirements that giveway declares, as installed or in its repository."""
    try:
        declared = metadata.requires("giveway") or []
    except metadata.PackageNotFoundError:
        project = Path(__file__).resolve().parents[2] / "pyproject.toml"
        if not project.is_file():
            return []
        content = tomllib.loads(project.read_text(encoding="utf-8"))
        declared = content["project"]["dependencies"]
    requirements = []
    for text in declared:
        try:
            requirement = Requirement(text)
        except InvalidRequirement:
            continue
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            requirements.append(requirement)
    return requirements


def _sumo() -> list[Finding]:
    """Load libsumo in a process of its own, which may crash."""
    remedy = "pip install --force-reinstall 'libsumo>=1.28,<1.29'"
    try:
        result = subprocess.run(
            [sys.executable, "-c", _IMPORT_SUMO],
            capture_output=True,
            text=True,
            check=False,
            timeout=_PATIENCE,
        )
    except (OSError, subprocess.TimeoutExpired) as problem:
        return [error("SUMO", f"libsumo does not load ({problem})", remedy)]
    if result.returncode != 0:
        reason = (result.stderr.strip().splitlines() or [f"exit code {result.returncode}"])[-1]
        return [error("SUMO", f"libsumo does not load: {reason}", remedy)]
    version = result.stdout.strip().splitlines()[-1]
    if not version.removeprefix("SUMO ").startswith("1.28."):
        text = f"{version}; the coupling was measured on 1.28"
        return [warning("SUMO", text, remedy)]
    return [ok("SUMO", f"{version} loads")]


def _vehicle() -> list[Finding]:
    findings = []
    for version in ("2.0", "3.0"):
        subject = f"vehicle, FMI {version}"
        try:
            with VehicleFmu(bundled_fmu(version), step_size=0.05) as vehicle:
                vehicle.start(position=0.0, speed=1.0)
                vehicle.step(0.0)
                findings.append(ok(subject, f"the bundled FMU steps ({vehicle.position:.3f} m)"))
        except FmuError as problem:
            remedy = "reinstall giveway, or name another FMU with --vehicle"
            findings.append(error(subject, str(problem), remedy))
    return findings


def _solver() -> list[Finding]:
    """Solve the MPC's problem with no pedestrian on the path."""
    remedy = "pip install --force-reinstall 'osqp>=1.1,<1.2'"
    try:
        mpc = Mpc(LongitudinalModel(), MpcParameters())
        solution = mpc.solve(0.0, 1.0, 0.0, np.full(mpc.parameters.horizon, np.inf))
    except (ControllerError, RuntimeError) as problem:
        return [error("OSQP", f"does not solve ({problem})", remedy)]
    if not solution.found:
        return [error("OSQP", f"an empty road has no solution ({solution.status})", remedy)]
    return [ok("OSQP", f"solves in {solution.iterations} iterations")]


def _kernels() -> list[Finding]:
    """Check that numba compiles, and that compiled code is kept and is undamaged."""
    import numba

    from giveway._kernels.cache import kernel_place
    from giveway._kernels.kept_code import damaged

    try:
        if cast("Any", numba.njit)(_one_more)(1) != 2:
            return [error("numba", "computes 1 + 1 wrongly", "reinstall numba and llvmlite")]
    except Exception as problem:  # an error of numba, llvmlite or the operating system
        reason = f"does not compile ({problem})"
        return [error("numba", reason, "reinstall numba and llvmlite")]
    folder, why = kernel_place()
    if why:
        remedy = "every process compiles for half a minute; set NUMBA_CACHE_DIR to your own folder"
        return [warning("numba", f"{why}, so that no kernels are kept", remedy)]
    names = [file.name for file in damaged(folder)]
    if names:
        text = f"{len(names)} damaged files of kernels in {folder}, like {names[0]}"
        return [warning("numba", text, "they are compiled anew when needed; look at the disk")]
    return [ok("numba", f"{numba.__version__} compiles; kernels in {folder}")]


def _one_more(number: int) -> int:
    return number + 1


def _folder(subject: str, folder: Path, remedy: str) -> list[Finding]:
    existing = next((path for path in (folder, *folder.parents) if path.exists()), Path("/"))
    if not existing.is_dir() or not os.access(existing, os.W_OK | os.X_OK):
        return [error(subject, f"{existing} cannot be written", remedy)]
    free = shutil.disk_usage(existing).free
    text = f"{folder}, {free / 1e9:.1f} GB free"
    if free < _ENOUGH_SPACE:
        return [warning(subject, text, f"make room, or {remedy}")]
    return [ok(subject, text)]


def _terminal() -> list[Finding]:
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    try:
        _CHARACTERS.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        text = f"{encoding} lacks characters of our summaries; they show as '?'"
        return [note("terminal", text, "set PYTHONIOENCODING=utf-8")]
    return [ok("terminal", encoding)]
