"""A run as a child process: its heartbeat, its supervisor, and its end in words."""
