"""How people enter a run."""
