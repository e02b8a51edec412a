"""The safety layer below every controller."""
