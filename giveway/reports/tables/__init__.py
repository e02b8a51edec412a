"""Tables of a report, with names in words and units."""
