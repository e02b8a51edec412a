"""What the terminal shows: tables, progress bars and lines."""
