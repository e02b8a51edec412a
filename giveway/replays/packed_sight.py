"""The cameras of egos, what hides people from them, and who is perceived, for the page."""

from collections.abc import Iterable
from math import inf
from typing import Any

from giveway.figures.sight_view import SightView
from giveway.replays.run_folder import RunFolder
from giveway.run_data.scene import Opaque

_TALL = 1e3  # Height [m] of a vehicle whose height is not on record


def heights_of(run: RunFolder, vehicles: Iterable[str]) -> list[float]:
    """Return the heights [m] of vehicles, as far as cameras are concerned."""
    known = (run.scene.opaque or Opaque()).heights
    return [known.get(name, _TALL) for name in vehicles]


def walls_of(run: RunFolder) -> list[list[float]]:
    """Return the sides of opaque polygons: x0, y0, x1, y1, height [m]."""
    walls: list[list[float]] = (run.scene.opaque or Opaque()).walls.tolist()
    return walls


def pack_sight(run: RunFolder, ego: str, names: dict[str, int]) -> dict[str, Any]:
    """Return the height of an ego, and its sight: cameras, and when it perceives whom, or None.

    Args:
        run: Results folder.
        ego: Id of the ego.
        names: Index of each pedestrian on the page.
    """
    view = SightView.of(run.egos[ego], run.sights_of(ego), run.scene.opaque or Opaque())
    return {
        "height": heights_of(run, [ego])[0],
        "sight": None if view is None else _packed(view, names),
    }


def _packed(view: SightView, names: dict[str, int]) -> dict[str, Any]:
    return {
        "cameras": [list(mount.row) for mount in view.mounts],
        "stretches": {
            str(names[who]): [[begin, until if until < inf else None] for begin, until in them]
            for who, them in view.stretches.items()
            if who in names
        },
    }
