"""Replays: one page that plays a run, in any browser and without a network."""

from giveway.replays.page import write_replay

__all__ = ["write_replay"]
