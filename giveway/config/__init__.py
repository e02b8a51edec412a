"""The configuration of a run: options declared once, settings merged from layers and validated."""

from giveway.config.run_config import EgoRunConfig, RunConfig

__all__ = ["EgoRunConfig", "RunConfig"]
