"""The pictures of studies, each drawn from the tables of a study."""
