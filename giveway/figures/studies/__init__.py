"""Pictures of studies; each is drawn from the tables of a study."""
