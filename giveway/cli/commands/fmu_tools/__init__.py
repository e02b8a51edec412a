"""The commands of ``giveway fmu``."""
