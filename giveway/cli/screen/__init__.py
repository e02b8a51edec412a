"""The output to the terminal: tables, progress bars and lines."""
