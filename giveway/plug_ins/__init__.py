"""Code of other packages: where it is installed, what it is, and what it may be told."""
