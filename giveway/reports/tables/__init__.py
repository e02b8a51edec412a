"""The tables of a report, with names in words and units."""
