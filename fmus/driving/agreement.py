"""The agreement between an FMU's position and its integrated speed."""

from collections import deque

WINDOW = 0.5  # [s] time over which the two are compared
APART = 0.5  # [m] largest difference of position and integrated speed within the window
SLIP = 0.2  # largest difference as a share of the distance, where that is more


class Agreement:
    """The comparison of the distance by position with that by speed, lately and since the start.

    A position that counts in steps, like an odometer, stands still and jumps. It may be behind or
    ahead by one of its steps, whose size is learnt from the jumps. Before the first jump it may
    stand still for the largest allowed jump.

    Args:
        jump: Largest difference [m] of position and integrated speed in one step and in total.
            Above the usual 1 m it also widens the tolerance within the window.
    """

    def __init__(self, jump: float) -> None:
        self._jump = jump
        self._apart = max(APART, APART * jump)
        self._distance = 0.0  # [m] driven since the start, by the speed
        self._drift = 0.0  # [m] by which the position is ahead of the integrated speed
        self._slack = 0.0  # [m] largest error of the integrated speed
        self._standing = 0.0  # [m] driven since the position last changed
        self._quantum = 0.0  # [m] largest jump of a position that had stood still
        self._past: deque[tuple[float, float, float]] = deque([(0.0, 0.0, 0.0)])

    def lost(
        self, moved: float, way: float, slack: float, duration: float
    ) -> tuple[float, float, float] | None:
        """Take over one step; return how position and speed differ, or None if they agree.

        Args:
            moved: Change of the position [m].
            way: Integral of the speed, by the trapezoid rule [m].
            slack: Largest error of that position [m].
            duration: Duration of the step [s].

        Returns:
            The distance by position [m], the distance by speed [m] and the time [s] in which they
            came to differ (0 s: since the start). None if they agree.
        """
        self._count(moved, way)
        self._drift += moved - way
        self._distance += abs(way)
        self._slack += slack
        past = self._past
        before, distance_before, slack_before = past[0]
        drift, distance = self._drift - before, self._distance - distance_before
        apart = abs(drift) - (self._slack - slack_before)
        past.append((self._drift, self._distance, self._slack))
        steps = len(past) - 1
        if steps * duration >= WINDOW * (1.0 - 1e-9):
            past.popleft()
        waits = 0.0 < self._standing <= (1.0 + SLIP) * self._jump
        if apart > max(self._apart, SLIP * distance) + self._quantum and not waits:
            return distance + drift, distance, steps * duration
        if abs(self._drift) > self._jump + SLIP * self._distance:
            return self._distance + self._drift, self._distance, 0.0
        return None

    def _count(self, moved: float, way: float) -> None:
        """Learn the increments in which the position counts."""
        if moved == 0.0:
            self._standing += abs(way)
        else:
            if self._standing > 0.0:
                self._quantum = max(self._quantum, min(abs(moved), self._jump))
            self._standing = 0.0
