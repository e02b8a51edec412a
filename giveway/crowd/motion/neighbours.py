"""The base class of models that wrap another pedestrian model."""

from pedestrian_model import PedestrianModel, VciParameters


class AroundModel:
    """A model that wraps another one and has its bodies, limits and time step.

    Args:
        model: Model that moves all people.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self._model = model

    @property
    def parameters(self) -> VciParameters:
        """The bodies and limits of the wrapped model."""
        return self._model.parameters

    @property
    def time_step(self) -> float:
        """The time step [s] of the wrapped model."""
        return self._model.time_step
