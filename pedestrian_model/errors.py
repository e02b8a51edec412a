"""Errors of the pedestrian model, one class for each thing that a user can act on."""


class PedestrianModelError(Exception):
    """Root of the errors of this room."""


class ParameterError(PedestrianModelError):
    """A parameter of the model, or a time step or horizon, is out of its range."""


class CrowdError(PedestrianModelError):
    """The state of a crowd is malformed: a shape, an index, or a value that is not finite."""


class VehicleError(PedestrianModelError):
    """The description of the vehicles is malformed."""


class SurroundingsError(PedestrianModelError):
    """The walls or signals are malformed, or do not fit the crowd."""


class DivergenceError(PedestrianModelError):
    """A step produced a state that is not finite."""


class PlugInError(PedestrianModelError):
    """Somebody else's model raised, or answered what no crowd can do.

    Attributes:
        person: which of the pedestrians it was about; None: all of them.
    """

    def __init__(self, message: str, person: int | None = None) -> None:
        super().__init__(message)
        self.person = person
