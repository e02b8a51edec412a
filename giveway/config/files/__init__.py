"""How a configuration is read from files and flags."""
