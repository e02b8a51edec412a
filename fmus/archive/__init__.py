"""Zip archives: what may be unpacked of a foreign FMU, and archives with reproducible bytes."""
