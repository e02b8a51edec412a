"""The results of a run: result object, tables, folder, pictures and provenance."""
