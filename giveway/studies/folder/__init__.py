"""The folder of a study: its records, tables, seals and lock."""
