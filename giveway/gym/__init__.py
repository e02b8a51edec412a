"""A run as a Gymnasium environment (extra ``gym``); see docs/gym.md."""

from giveway.gym.drive import DriveEnv, Seat

__all__ = ["DriveEnv", "Seat"]
