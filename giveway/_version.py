"""The version of giveway, importable from every floor."""

__version__ = "0.1.0"
