"""Reading, loading and calling FMUs: the only package that talks to FMPy."""

from fmus.fmi._interim import describe, load, read_model

__all__ = ["describe", "load", "read_model"]
