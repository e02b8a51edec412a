"""All that comes before other imports: signals during the start, checks, and settings."""
