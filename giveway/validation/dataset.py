"""The description of a data set that its files lack: the frame rate and the vehicle's body."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from pydantic import ValidationError

from giveway.config.files.toml import read_toml_file
from giveway.config.option import Section, expectation, option
from giveway.errors import ConfigError

_FORM = (
    'a table like: name = "MINE", frame_rate = 25.0, y_axis = "down", [vehicle] front = 2.2, '
    "rear = 2.2, width = 1.8"
)
_BODY = "it is a vehicle's, from the tracked point"


class Body(Section):
    """The body of the vehicles about the point that is tracked."""

    front: float = option(..., "m", "from the tracked point to the front", ge=0.0, le=20.0)
    rear: float = option(..., "m", "from the tracked point to the rear", ge=0.0, le=20.0)
    width: float = option(..., "m", "of the body", ge=0.1, le=10.0, because=_BODY)


class Dataset(Section):
    """The description of a data set whose files have the columns of CITR and DUT."""

    name: str = option(..., None, "how it is called", min_length=1)
    frame_rate: float = option(
        ..., "1/s", "of the camera", ge=0.5, le=1000.0, because="a camera's is between these"
    )
    vehicle: Body
    y_axis: Literal["down", "up"] = option("down", None, "where y points, down as in an image")


CITR = Dataset(
    name="CITR", frame_rate=29.97, vehicle=Body(front=1.0, rear=1.2, width=1.2), y_axis="down"
)
"""Controlled experiments with a golf cart (Yang et al. 2019, arXiv 1902.00487)."""

DUT = Dataset(
    name="DUT", frame_rate=23.976, vehicle=Body(front=2.25, rear=2.25, width=1.8), y_axis="down"
)
"""Crowded campus, with cars of about 4.5 m by 1.8 m (Yang et al. 2019, arXiv 1902.00487)."""

DATASETS: Mapping[str, Dataset] = MappingProxyType({"citr": CITR, "dut": DUT})


def dataset_of(wanted: str | None) -> Dataset:
    """Return the description that ``--dataset`` names: a known one, or that of a TOML file.

    Raises:
        ConfigError: no data set is named, or it cannot be used.
    """
    known = " or ".join(DATASETS)
    if not wanted:
        raise ConfigError(
            f"--dataset: missing; expected {known}, or a TOML file with the frame rate and the "
            f"vehicle's body, which trajectories do not say of themselves: {_FORM}"
        )
    if wanted.lower() in DATASETS:
        return DATASETS[wanted.lower()]
    if not wanted.endswith(".toml"):
        raise ConfigError(
            f"--dataset {wanted}: expected {known}, or a description (.toml): {_FORM}"
        )
    return _read(Path(wanted))


def _read(file: Path) -> Dataset:
    origin = f"--dataset {file}"
    values = read_toml_file(file, "the description of a data set", origin)
    try:
        return Dataset.model_validate(values)
    except ValidationError as error:
        raise ConfigError(f"{origin}: {_explain(error.errors(include_url=False)[0])}") from None


def _explain(error: Mapping[str, object]) -> str:
    location = [str(part) for part in error["loc"]]  # type: ignore[attr-defined]
    model = Body if location[:1] == ["vehicle"] and len(location) > 1 else Dataset
    key = ".".join(location)
    field = model.model_fields.get(location[-1])
    if error["type"] == "missing":
        return f"{key} is missing; expected {_FORM}"
    if field is None or location == ["vehicle"]:
        return f"{key}: expected {_FORM}"
    return f"{key} = {error['input']!r}: {expectation(error, field)}"
