"""The errors of this package, one class per thing that a user can do something about."""


class ScenarioError(Exception):
    """A scenario cannot be found or read. The message tells what was expected and what to do."""


class BuildError(ScenarioError):
    """netconvert is missing, or refuses the sources of a scenario's road network."""
