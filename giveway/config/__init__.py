"""Options declared once, settings from layers, and one validated configuration of a run."""

from giveway.config.run_config import EgoRunConfig, RunConfig

__all__ = ["EgoRunConfig", "RunConfig"]
