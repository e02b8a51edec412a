"""The table of the configuration about the road: how fast, how close, and who goes first."""

from giveway.config.option import Section, SpeedOrLane, option
from giveway.config.reasons import MILLIMETRE
from giveway.config.tables.basics import DEFAULT_SPEED

CORRIDOR_MARGIN = 0.25
"""Width [m] by which a vehicle's corridor exceeds its body on each side."""


class RegulationConfig(Section):
    """The aims of all controllers, and the corridor in front."""

    reference_speed: SpeedOrLane | None = option(
        None,
        "m/s",
        "Desired speed v_r, or 'lane': the limit of the lane under the ego, less in bends. "
        f"By default it is lane, but {DEFAULT_SPEED:g} m/s for the paper's controllers",
        flag="--desired-speed",
        least=0.1,
        because=("a slower vehicle hardly moves", "no car is faster"),
    )
    safe_distance: float = option(
        8.0,
        "m",
        "Distance d_safe that is kept to people in front, and by the paper's controllers to "
        "vehicles as well",
        ge=0,
        le=500,
        least=MILLIMETRE,
        because=("a gap is at least a millimetre", "people are not seen so far ahead"),
    )
    critical_gap: float | None = option(
        None,
        "s",
        "Smallest gap to the next vehicle with priority in which the ego goes first. By default "
        "it depends on the manoeuvre, as in the Highway Capacity Manual",
        flag="--critical-gap",
        ge=0.5,
        le=60,
        because=("crossing takes longer", "drivers do not wait for such a gap"),
    )
