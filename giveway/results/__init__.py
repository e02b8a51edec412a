"""What a run leaves: the result object, its tables, folder, pictures and provenance."""
