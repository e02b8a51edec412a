"""The errors of the controllers, one class per cause that a user can remove."""


class ControllerError(Exception):
    """The root of the controllers' errors; the message is one line."""


class ParameterError(ControllerError):
    """A parameter is not what it must be: name, value, unit and expectation are named."""


class SolverSetupError(ControllerError):
    """The QP solver refuses the problem at set-up."""


class PlugInError(ControllerError):
    """A controller of somebody else's fails: it is named, with what it raised or returned."""
