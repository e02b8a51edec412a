"""Replays: a page that plays a run, or two side by side, in any browser and without a network."""

from giveway.replays.replay_page import content_of, write_beside, write_replay

__all__ = ["content_of", "write_beside", "write_replay"]
