"""What stands round a model of people and changes how it moves them."""

from pedestrian_model import PedestrianModel, VciParameters


class AroundModel:
    """Has the bodies, limits and time step of the model inside.

    Args:
        model: that moves everybody.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self._model = model

    @property
    def parameters(self) -> VciParameters:
        """Bodies and limits."""
        return self._model.parameters

    @property
    def time_step(self) -> float:
        """[s]."""
        return self._model.time_step
