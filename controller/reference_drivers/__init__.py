"""Reference drivers: models of human drivers to compare the controllers with."""
