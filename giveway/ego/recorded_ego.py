"""An ego that repeats its recorded drive, without a vehicle FMU and a controller."""

from pathlib import Path

from controller import Decision, Observation
from fmus import Vehicle
from giveway.run_data.tracks import EgoTrack


class RecordedVehicle(Vehicle):
    """A vehicle that repeats a recorded motion.

    Args:
        track: Recorded rows of the ego, from its departure on. The last row holds beyond its end.
        time_step: Control step [s].
    """

    def __init__(self, track: EgoTrack, time_step: float) -> None:
        super().__init__(Path())
        self.warnings = []
        self.step_size = time_step
        self._track = track
        self._row = 0
        self._show()

    def _show(self) -> None:
        track, row = self._track, self._row
        self.position = float(track.position[row])
        self.speed = float(track.speed[row])
        self.acceleration = float(track.acceleration[row])
        self.stop_gap = float(track.stop_gap[row])  # distance [m] to a demanded stop; inf without

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:  # noqa: ARG002
        """Begin again at the first row of the track; the arguments are ignored."""
        self._row = 0
        self._show()

    def step(self, force: float = 0.0, grade: float = 0.0) -> None:  # noqa: ARG002
        """Go to the next row of the track; the arguments are ignored."""
        self._row = min(self._row + 1, len(self._track.time) - 1)
        self._show()

    def close(self) -> None:
        """Do nothing: there is nothing to free."""


class NoController:
    """Takes the place of a recorded ego's controller, and is never asked for a force."""

    horizon = 0
    foresees = False

    def reset(self) -> None:
        """Do nothing: there is nothing to forget."""

    def control(self, observation: Observation) -> Decision:  # noqa: ARG002
        """Raise an error, because a recorded ego asks no controller."""
        raise AssertionError("an ego whose motion is known asks no controller")

    def applied(self, force: float) -> None:
        """Do nothing: a recorded ego has no safety layer."""
