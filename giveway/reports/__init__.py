"""The report of a study: pictures, tables and sentences in one HTML file."""
