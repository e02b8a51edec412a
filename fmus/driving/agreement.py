"""Whether an FMU's position and its speed tell of the same motion."""

from collections import deque

WINDOW = 0.5  # [s] over which they are compared
APART = 0.5  # [m] by which the position may leave the integrated speed within the window
SLIP = 0.2  # share of the way by which it may, where that is more


class Agreement:
    """Compares the way by the position with that by the speed, lately and since the start.

    A position that counts in steps, as an odometer does, stands and jumps; it may be behind or
    ahead by one of its steps, which is learnt from its jumps. Until the first one it may stand as
    long as a jump is allowed to be.

    Args:
        jump: [m] by which the position may leave the integrated speed in one step, and altogether;
            beyond the usual 1 m it widens what is allowed within the window, too.
    """

    def __init__(self, jump: float) -> None:
        self._jump = jump
        self._apart = max(APART, APART * jump)
        self._distance = 0.0  # [m] driven since the start, by the speed
        self._drift = 0.0  # [m] by which the position has moved farther
        self._slack = 0.0  # [m] by which the integral of the speed may be wrong
        self._standing = 0.0  # [m] driven since the position last changed
        self._quantum = 0.0  # [m] largest step of a position that had stood
        self._past: deque[tuple[float, float, float]] = deque([(0.0, 0.0, 0.0)])

    def lost(
        self, moved: float, way: float, slack: float, duration: float
    ) -> tuple[float, float, float] | None:
        """Take over one step; what has come apart in it, if anything has.

        Args:
            moved: change of the position [m].
            way: integral of the speed, by the trapezoid rule [m].
            slack: Largest error of that position [m].
            duration: Duration of the step [s].

        Returns:
            the way by the position [m], that by the speed [m], and in how long [s]; 0 s: since the
            start. None: they agree.
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
        """Learn the steps in which the position counts."""
        if moved == 0.0:
            self._standing += abs(way)
        else:
            if self._standing > 0.0:
                self._quantum = max(self._quantum, min(abs(moved), self._jump))
            self._standing = 0.0
