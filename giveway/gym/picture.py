"""The picture of an instant of an environment: the ego and the people around it, from above."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from giveway.figures.style import BLUE, LIGHT_GREY, VERMILION
from giveway.geometry.kernel import Array

Bytes = NDArray[np.uint8]

_SIZE = 640, 320  # Size [pixels]
_FINER = 2  # factor between the painted and the final size
_AHEAD, _BEHIND = 32.0, 8.0  # Lengths [m] that are shown, from the front bumper
_TICK = 1.0  # [s] length of the walking direction's mark, as a time


def picture(body: tuple[float, float], radius: float, way: Array, people: Array) -> Bytes:
    """Return an RGB picture in which the ego drives to the right.

    Args:
        body: Length and width [m] of the ego.
        radius: Radius [m] of a person.
        way: Points (n, 2) of the way ahead [m], from the front bumper: ahead, left.
        people: Places [m] and velocities [m/s] (m, 4) of people in the same frame.

    Returns:
        Bytes (height, width, 3).
    """
    size = (_FINER * _SIZE[0], _FINER * _SIZE[1])
    scale = size[0] / (_AHEAD + _BEHIND)
    canvas = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(canvas)

    def pixels(points: Array) -> list[tuple[float, float]]:
        x, y = (points[:, 0] + _BEHIND) * scale, size[1] / 2.0 - points[:, 1] * scale
        return list(zip(x.tolist(), y.tolist(), strict=True))

    length, width = body
    draw.line(pixels(way), fill=LIGHT_GREY, width=round(width * scale), joint="curve")
    ((left, top), (right, bottom)) = pixels(np.array([[-length, width / 2], [0.0, -width / 2]]))
    draw.rectangle((left, top, right, bottom), fill=BLUE)
    for person in people:
        place, velocity = person[:2], person[2:]
        (x, y), ahead = pixels(np.array([place, place + _TICK * velocity]))
        r = radius * scale
        draw.line([(x, y), ahead], fill="black", width=_FINER)
        draw.ellipse((x - r, y - r, x + r, y + r), fill=VERMILION)
    return np.asarray(canvas.reduce(_FINER))
