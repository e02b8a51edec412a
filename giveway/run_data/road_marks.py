"""The marks on a road: pedestrian crossings and the stop lines of traffic lights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

Point = tuple[float, float]


class Zebra(NamedTuple):
    """A pedestrian crossing, with or without a light."""

    ends: tuple[Point, Point]  # [m] middle of each kerb
    width: float  # [m]


class SignalHead(NamedTuple):
    """A light, shown as the stop line of the lane that it governs."""

    ends: tuple[Point, Point]  # [m] ends of the stop line
    system: str  # SUMO's id of the traffic light
    links: tuple[int, ...]  # indices of the lane's movements in the light's state


@dataclass(frozen=True)
class RoadMarks:
    """All crossings and stop lines of a network, or of a part of it."""

    zebras: tuple[Zebra, ...] = ()
    heads: tuple[SignalHead, ...] = ()

    def within(self, low: Point, high: Point) -> RoadMarks:
        """Return the marks that begin or end in a rectangle, given by its corners [m]."""

        def inside(ends: tuple[Point, Point]) -> bool:
            return any(low[0] <= x <= high[0] and low[1] <= y <= high[1] for x, y in ends)

        return RoadMarks(
            tuple(zebra for zebra in self.zebras if inside(zebra.ends)),
            tuple(head for head in self.heads if inside(head.ends)),
        )

    def as_dict(self) -> dict[str, Any]:
        """Return the marks as JSON values; empty if there are none."""
        found: dict[str, Any] = {}
        if self.zebras:
            found["zebras"] = [zebra._asdict() for zebra in self.zebras]
        if self.heads:
            found["heads"] = [head._asdict() for head in self.heads]
        return found

    @classmethod
    def from_dict(cls, kept: dict[str, Any]) -> RoadMarks:
        """Return the marks from the values of ``as_dict``.

        Raises:
            KeyError, TypeError, ValueError: the values are not those of marks.
        """
        return cls(
            tuple(
                Zebra(_ends(zebra["ends"]), float(zebra["width"]))
                for zebra in kept.get("zebras", ())
            ),
            tuple(
                SignalHead(_ends(head["ends"]), str(head["system"]), tuple(map(int, head["links"])))
                for head in kept.get("heads", ())
            ),
        )


UNMARKED = RoadMarks()


def shown(letters: str) -> str:
    """Return the letter to show for a lane whose movements have the states ``letters``.

    It is green if any movement may go, else yellow, else red; otherwise, for example if the light
    is off, it is empty.
    """
    for sought in ("Gg", "yu", "rR"):
        if any(letter in sought for letter in letters):
            return sought[0]
    return ""


def _ends(kept: Any) -> tuple[Point, Point]:
    (a, b), (c, d) = kept
    return (float(a), float(b)), (float(c), float(d))
