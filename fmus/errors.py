"""The errors of an FMU, one class per problem that a user can solve."""


class FmuError(Exception):
    """The root of all errors of this package. The message is one line and names the FMU."""


class FmuFileError(FmuError):
    """The file is missing, or no readable FMU."""


class FmuArchiveError(FmuFileError):
    """The archive is malicious, damaged or too large; nothing of it was unpacked."""


class FmuProfileError(FmuError):
    """A vehicle profile cannot be used."""


class FmuInterfaceError(FmuError):
    """The FMU has no interface that can be run here."""


class FmuPlatformError(FmuError):
    """The FMU has no binary for this platform, or the binary cannot be loaded."""


class FmuVariableError(FmuError):
    """A variable is missing, or is not what it is used for."""


class FmuStartError(FmuError):
    """The FMU refused to be instantiated or initialised."""


class FmuStepError(FmuError):
    """The FMU did not do a step."""


class FmuOutputError(FmuError):
    """The FMU's outputs are no finite numbers, or none that a car can have."""


class FmuUnsuitableError(FmuOutputError):
    """The FMU runs, but not as a vehicle that can be driven and stopped as told."""


class FmuCrashError(FmuStepError):
    """The FMU's process died, or hung and was ended."""


class FmuStartCrashError(FmuCrashError):
    """The FMU's process died or hung before its first step."""


class FmuStateError(FmuError):
    """A call that the vehicle's or the FMU's present state does not allow."""


class FmuBuildError(FmuError):
    """An FMU cannot be compiled here."""
