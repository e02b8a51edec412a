"""``giveway plot``."""

from __future__ import annotations

import difflib
import math
from pathlib import Path

from rich.console import Console

from giveway.errors import ConfigError, ResultsError
from giveway.figures import influence_figure
from pedestrian_model import PRESETS, Vehicles, vehicle_influence

_SUFFIXES = (".png", ".svg", ".pdf")
