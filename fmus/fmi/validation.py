"""The findings of FMPy's validation of an FMU."""

from pathlib import Path

from fmus.text import printable


def findings(path: Path) -> list[str]:
    """Return the findings of FMPy's validation, one line each.

    FMUs of well-known tools have findings, too.
    """
    from fmpy.validation import validate_fmu

    return [printable(problem) for problem in validate_fmu(str(path))]
