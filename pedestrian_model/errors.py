"""The errors of the pedestrian model, one class for each cause that a user can remove."""


class PedestrianModelError(Exception):
    """The root of the errors of this package."""


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
    """A model of another package raised an error, or its answer is not valid.

    Attributes:
        person: Row of the pedestrian that the error is about, or None for the whole crowd.
    """

    def __init__(self, message: str, person: int | None = None) -> None:
        super().__init__(message)
        self.person = person
