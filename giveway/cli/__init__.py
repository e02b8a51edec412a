"""The command line: ``giveway run``, ``giveway study``, ``giveway fmu check`` and the others.

Only what the asked-for command needs is imported, so that ``giveway --help`` answers at once.
"""

from giveway.cli.program import main

__all__ = ["main"]
