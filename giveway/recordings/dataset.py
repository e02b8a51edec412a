"""The description of a data set: its files, columns, units, frame rate and the vehicles' body."""

from collections.abc import Mapping
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ValidationError, model_validator

from giveway.config.files.toml import parse_toml, read_toml_file
from giveway.config.option import Section, expectation, option
from giveway.errors import ConfigError

_FORM = (
    'a table like: name = "MINE", frame_rate = 25.0, y_axis = "down", [vehicle] front = 2.2, '
    "rear = 2.2, width = 1.8"
)
_BODY = "it is a vehicle's, from the tracked point"
_LAYOUT = "citr"  # Data set whose tables are those of a description without any

KNOWN = ("citr", "deepscenario", "dut", "eth_ucy", "hermes", "imptc", "ind", "sind", "sumo_fcd")
"""Names of the data sets whose descriptions giveway brings."""


class Body(Section):
    """The body of the vehicles about the point that is tracked."""

    front: float = option(..., "m", "from the tracked point to the front", ge=0.0, le=20.0)
    rear: float = option(..., "m", "from the tracked point to the rear", ge=0.0, le=20.0)
    width: float = option(..., "m", "of the body", ge=0.1, le=10.0, because=_BODY)


class Units(Section):
    """The units of a data set's files."""

    length: Literal["m", "cm", "mm"] = option("m", None, "unit of places and bodies")
    speed: Literal["m/s", "cm/s", "mm/s", "km/h"] = option("m/s", None, "unit of speeds")
    angle: Literal["rad", "deg"] = option("rad", None, "unit of headings")


class Columns(Section):
    """The names in a file of what giveway reads; an empty name is a column that is not there."""

    id: str = option("", None, "id of a track; empty if each file is one track")
    frame: str = option("", None, "number of the frame")
    time: str = option("", None, "time; it counts only where there is no frame")
    x: str = option(..., None, "place x", min_length=1)
    y: str = option(..., None, "place y", min_length=1)
    vx: str = option("", None, "velocity along x; empty: by heading and speed, or differences")
    vy: str = option("", None, "velocity along y")
    heading: str = option("", None, "heading; empty: the direction of the velocity")
    speed: str = option("", None, "speed; empty: that of the velocity")
    length: str = option("", None, "length of a body whose centre is tracked; 0 is unknown")
    width: str = option("", None, "width of a body; 0 is unknown")
    kind: str = option("", None, "label that tells people from vehicles")

    @property
    def given(self) -> dict[str, str]:
        """The names of the columns that are there, by giveway's names."""
        return {name: column for name, column in self if column}


class Join(Section):
    """A second file with one row per track."""

    files: str = option(..., None, "pattern of the files, {name} as in the tracks'", min_length=1)
    id: str = option(..., None, "column of the track's id", min_length=1)
    kind: str = option(..., None, "column of the label", min_length=1)


class RateFile(Section):
    """A file that holds the frame rate of its recording."""

    files: str = option(..., None, "pattern of the files, {name} as in the tracks'", min_length=1)
    column: str = option(..., None, "column of the frame rate", min_length=1)


class LightFile(Section):
    """The files of traffic lights; they are checked, no measure needs them."""

    files: tuple[str, ...] = option(..., None, "patterns of their names", min_length=1)
    columns: str = option(..., None, "word in the name of each column of codes", min_length=1)
    codes: tuple[int, ...] = option(..., None, "codes that are known", min_length=1)


class Corridor(Section):
    """The straight corridor in which people walk one way, for ``giveway data behave``.

    Places are in giveway's frame: metres, y up.
    """

    right: tuple[float, float, float, float] = option(
        ..., "m", "wall on people's right: x and y of the entrance, x and y of the exit"
    )
    width: float | None = option(None, "m", "between the walls; or it is in the names", gt=0.0)
    exit: float | None = option(None, "m", "width of the exit; or it is in the names", gt=0.0)
    exit_from: float | None = option(
        None, "m", "from the right wall to the exit, which else is in the middle", ge=0.0
    )
    names: str = option(
        "", None, "pattern of names; {width} and {exit} are numbers in the unit of length"
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for key in ("width", "exit"):
            if getattr(self, key) is None and f"{{{key}}}" not in self.names:
                raise ValueError(f"corridor.{key} is missing; give it, or {{{key}}} in names")
        return self


class TrackTable(Section):
    """One kind of file with tracks."""

    files: str = option(
        ..., None, "pattern: {name} is the recording, {track} one track", min_length=1
    )
    format: Literal["csv", "text", "parquet", "json", "xml"] = option("csv", None, "of the files")
    holds: Literal["people", "vehicles", "both"] = option("both", None, "road users in the files")
    header: tuple[str, ...] = option((), None, "names of the columns of a file without a header")
    rows: tuple[str, ...] = option((), None, "json: key of the rows; xml: names of the elements")
    columns: Columns
    join: Join | None = None


class Dataset(Section):
    """The description of a data set; without ``tables``, its files are like those of CITR."""

    name: str = option(..., None, "how it is called", min_length=1)
    site: str = option("", None, "where it was recorded")
    citation: str = option("", None, "what its authors ask users to cite")
    frame_rate: float = option(
        ..., "1/s", "of the camera", ge=0.5, le=1000.0, because="a camera's is between these"
    )
    vehicle: Body
    y_axis: Literal["down", "up"] = option("down", None, "where y points, down as in an image")
    heading_zero: Literal["x", "north"] = option(
        "x", None, "heading 0 is x and counter-clockwise, or north and clockwise"
    )
    units: Units = Units()
    people: tuple[str, ...] = option((), None, "labels of people; empty: all of a people's file")
    vehicles: tuple[str, ...] = option((), None, "labels of vehicles")
    tables: tuple[TrackTable, ...] = ()
    rate_file: RateFile | None = None
    lights: LightFile | None = None
    corridor: Corridor | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for table in self.tables:
            columns = table.columns
            if not (columns.frame or columns.time):
                raise ValueError(f"{table.files}: columns have neither frame nor time; give one")
            if not columns.id and "{track}" not in table.files:
                raise ValueError(f"{table.files}: columns.id is missing; give it, or {{track}}")
            if table.holds == "both" and not (columns.kind or table.join):
                raise ValueError(f"{table.files}: holds both, without a label; give columns.kind")
        return self

    @property
    def layout(self) -> tuple[TrackTable, ...]:
        """The tables of the data set's files."""
        return self.tables or bundled(_LAYOUT).tables


@cache
def bundled(name: str) -> Dataset:
    """Return the description of a data set that giveway brings."""
    file = resources.files("giveway.recordings") / "datasets" / f"{name}.toml"
    text = file.read_text(encoding="utf-8")
    return Dataset.model_validate(parse_toml(text, f"{name}.toml"))


CITR = bundled("citr")
"""Controlled experiments with a golf cart (Yang et al. 2019, arXiv 1902.00487)."""

DUT = bundled("dut")
"""Crowded campus, with cars of about 4.5 m by 1.8 m (Yang et al. 2019, arXiv 1902.00487)."""


def dataset_of(wanted: str | None, origin: str = "--dataset") -> Dataset:
    """Return the description that ``--dataset`` names: a known one, or that of a TOML file.

    Args:
        wanted: Name of a known data set, or path of a TOML file.
        origin: Option that names it; messages begin with it.

    Raises:
        ConfigError: no data set is named, or it cannot be used.
    """
    known = ", ".join(KNOWN)
    if not wanted:
        raise ConfigError(
            f"{origin}: missing; expected one of {known}, or a TOML file with the frame rate "
            f"and the vehicle's body, which trajectories do not say of themselves: {_FORM}"
        )
    if wanted.lower() in KNOWN:
        return bundled(wanted.lower())
    if not wanted.endswith(".toml"):
        raise ConfigError(
            f"{origin} {wanted}: expected one of {known}, or a description (.toml): {_FORM}"
        )
    return _read(Path(wanted), origin)


def _read(file: Path, origin: str) -> Dataset:
    origin = f"{origin} {file}"
    values = read_toml_file(file, "the description of a data set", origin)
    try:
        return Dataset.model_validate(values)
    except ValidationError as error:
        raise ConfigError(f"{origin}: {_explain(error.errors(include_url=False)[0])}") from None


def _explain(error: Mapping[str, Any]) -> str:
    location = list(error["loc"])
    key = ".".join(str(part) for part in location)
    if error["type"] == "value_error":  # of several keys
        return str(error["msg"]).removeprefix("Value error, ")
    model: type[BaseModel] = Dataset
    for part in location[:-1]:
        if isinstance(part, str) and part in model.model_fields:
            model = _TABLES.get(part, model)
    field = model.model_fields.get(str(location[-1]))
    if error["type"] == "missing":
        example = _FORM if model in {Dataset, Body} else f"a text ({_meaning(model, location)})"
        return f"{key} is missing; expected {example}"
    if field is None or location[-1] in _TABLES:
        known = ", ".join(model.model_fields)
        return f"{key}: expected {_FORM if model in {Dataset, Body} else f'one of {known}'}"
    return f"{key} = {error['input']!r}: {expectation(error, field)}"


def _meaning(model: type[BaseModel], location: list[Any]) -> str:
    return str(model.model_fields[str(location[-1])].description)


_TABLES: dict[str, type[BaseModel]] = {
    "vehicle": Body,
    "units": Units,
    "tables": TrackTable,
    "columns": Columns,
    "join": Join,
    "rate_file": RateFile,
    "lights": LightFile,
    "corridor": Corridor,
}
