"""A run as a child process: its heartbeat, its supervisor, and the cause of its end."""
