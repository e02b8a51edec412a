"""Zip archives: the check of a foreign FMU, and writing with reproducible bytes."""
