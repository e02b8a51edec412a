"""An ego that drives as it did in a run: no vehicle FMU, no controller."""

from pathlib import Path

from controller import Decision, Observation
from fmus import Vehicle
from giveway.run_data.tracks import EgoTrack


class RecordedVehicle(Vehicle):
    """A vehicle whose motion is known.

    Args:
        track: Recorded rows of the ego, from its departure on; at the end the vehicle stands.
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
        self.stop_gap = float(track.stop_gap[row])  # [m] to where it had to stop; inf: nowhere

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:  # noqa: ARG002
        """Begin again; position and speed are those of the track."""
        self._row = 0
        self._show()

    def step(self, force: float = 0.0, grade: float = 0.0) -> None:  # noqa: ARG002
        """Move on by one control step, whatever the force."""
        self._row = min(self._row + 1, len(self._track.time) - 1)
        self._show()

    def close(self) -> None:
        """There is nothing to free."""


class NoController:
    """Stands in for the controller of a recorded ego; it is never asked for a force."""

    horizon = 0
    foresees = False

    def reset(self) -> None:
        """There is nothing to forget."""

    def control(self, observation: Observation) -> Decision:  # noqa: ARG002
        """Nobody asks."""
        raise AssertionError("an ego whose motion is known asks no controller")

    def applied(self, force: float) -> None:
        """Nobody tells."""
