"""The entry of people into a run."""
