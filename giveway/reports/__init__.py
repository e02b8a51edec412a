"""The report of a study: pictures, tables and words in one HTML file."""
