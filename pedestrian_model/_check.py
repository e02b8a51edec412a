"""Checks of arrays from callers, with messages that name the index and the value."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model.errors import PedestrianModelError

# Largest accepted number [m], [m/s] or [rad]. Squares and differences of larger coordinates are not
# accurate in float64.
LARGEST = 1e9


def as_floats(
    values: ArrayLike, what: str, error: type[PedestrianModelError]
) -> NDArray[np.float64]:
    """Return a C-contiguous float64 array of ``values``, which is a copy only if needed.

    Raises:
        error: if ``values`` are not numbers.
    """
    try:
        return np.asarray(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as cause:
        raise error(f"{what}: expected numbers, got {values!r}") from cause


def check_shape(
    array: NDArray[np.generic],
    shape: tuple[int | None, ...],
    what: str,
    error: type[PedestrianModelError],
) -> None:
    """Raise ``error`` unless ``array`` has ``shape``, in which None stands for any length."""
    fits = array.ndim == len(shape) and all(
        wanted in (None, actual) for wanted, actual in zip(shape, array.shape, strict=True)
    )
    if not fits:
        wanted = "(" + ", ".join("any" if k is None else str(k) for k in shape) + ")"
        raise error(f"{what} has shape {array.shape}, expected {wanted}")


def check_values(array: NDArray[np.float64], what: str, error: type[PedestrianModelError]) -> None:
    """Raise ``error`` for the first value that is not finite or too large."""
    bad = ~(np.abs(array) <= LARGEST)
    if bad.any():
        index = tuple(int(k) for k in np.argwhere(bad)[0])
        raise error(
            f"{what}[{', '.join(map(str, index))}] = {array[index]}, "
            f"expected a finite number within +-{LARGEST:g}"
        )


def check_not_negative(
    array: NDArray[np.float64], what: str, error: type[PedestrianModelError]
) -> None:
    """Raise ``error`` for the first value below 0."""
    bad = array < 0.0
    if bad.any():
        index = int(np.argmax(bad))
        raise error(f"{what}[{index}] = {array[index]}, expected a value >= 0")
