"""The records of a run: columns, tracks, rows, and how it ended."""
