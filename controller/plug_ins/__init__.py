"""Controllers of other packages: their protocol, their wrapper, and a check of both."""
