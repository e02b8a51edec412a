"""What a run records: columns, tracks, rows, and how it ended."""
