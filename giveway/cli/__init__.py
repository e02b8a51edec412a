"""The command line: ``giveway run``, ``giveway study``, ``giveway fmu check`` and the others.

Only the modules of the requested command are imported, so that ``giveway --help`` answers at once.
"""

from giveway.cli.program import main

__all__ = ["main"]
