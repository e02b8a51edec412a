"""The reading of a configuration from files and flags."""
