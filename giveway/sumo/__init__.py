"""Everything that calls libsumo, and nothing else: sessions, vehicles, persons, lanes."""
