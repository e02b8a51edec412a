"""The errors of the controllers, one class per cause that a user can remove."""


class ControllerError(Exception):
    """The root of the controllers' errors; the message is one line."""


class ParameterError(ControllerError):
    """A parameter is invalid. The message has its name, value and unit, and what is expected."""


class SolverSetupError(ControllerError):
    """The QP solver refuses the problem at set-up."""


class PlugInError(ControllerError):
    """A controller of another package fails. The message has its name and what it did."""
