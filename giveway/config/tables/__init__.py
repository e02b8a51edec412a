"""The tables of the configuration."""
