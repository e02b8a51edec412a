"""The export of the controller as an FMU: the shipped FMU with other start values."""

import zipfile
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from fmus.archive.packing import write_archive
from fmus.errors import FmuBuildError, FmuFileError
from fmus.profile.bundled import FmiVersion
from fmus.sources.controller_description import model_description
from fmus.sources.parameters import CONTROLLER_FILES, ControllerParameters, token_of

_DESCRIPTION: Final = "modelDescription.xml"


def bundled_controller(fmi_version: FmiVersion = "2.0") -> Path:
    """Return the path of the shipped controller FMU, which has the paper's start values."""
    return Path(__file__).parent.parent / CONTROLLER_FILES[fmi_version]


def export_controller(
    path: Path,
    parameters: ControllerParameters | None = None,
    *,
    fmi_version: FmiVersion = "2.0",
) -> Path:
    """Write the controller as an FMU with these start values.

    It needs no compiler: the binaries, for five platforms, are those of the shipped FMU. The same
    parameters give the same bytes.

    Args:
        path: Path of the .fmu file; an existing file is replaced.
        parameters: Start values, or None for those of the paper.
        fmi_version: "2.0" (N scalar inputs for the predicted positions) or "3.0" (an array whose
            size follows the structural parameter N).

    Raises:
        FmuBuildError: the shipped FMU is missing, or there is none for this version.
        FmuFileError: the file cannot be written.
    """
    if fmi_version not in CONTROLLER_FILES:
        raise FmuBuildError(
            f"controller FMU: FMI {fmi_version}: expected one of {', '.join(CONTROLLER_FILES)}"
        )
    template = bundled_controller(fmi_version)
    try:
        with zipfile.ZipFile(template) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    except (OSError, zipfile.BadZipFile) as error:
        raise FmuBuildError(f"{template}: cannot be read ({error}); reinstall giveway") from error
    members[_DESCRIPTION] = _with_parameters(members[_DESCRIPTION], parameters, fmi_version)
    try:
        write_archive(path, members)
    except OSError as error:
        raise FmuFileError(f"{path}: cannot be written ({error.strerror or error})") from error
    return path


def _with_parameters(
    shipped: bytes, parameters: ControllerParameters | None, version: FmiVersion
) -> bytes:
    """Return the shipped FMU's description with other start values; all else stays."""
    root = ElementTree.fromstring(shipped)
    token = root.get("guid" if version == "2.0" else "instantiationToken") or ""
    wanted = parameters or ControllerParameters()
    return model_description(
        version,
        wanted,
        token=token_of(token.partition("}")[0] + "}", wanted),
        tool=root.get("generationTool") or "",
        sources=tuple(file.get("name") or "" for file in root.iter("File")),
    )
