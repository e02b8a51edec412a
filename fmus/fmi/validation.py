"""What FMPy's validation says of an FMU."""

from pathlib import Path

from fmus.text import printable


def findings(path: Path) -> list[str]:
    """What FMPy's validation finds fault with; each a line. FMUs of well-known tools have some."""
    from fmpy.validation import validate_fmu

    return [printable(problem) for problem in validate_fmu(str(path))]
