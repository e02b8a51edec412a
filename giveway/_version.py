"""The version of giveway, importable from every floor."""

from __future__ import annotations

__version__ = "0.1.0"
