"""Zip archives: the check of a foreign FMU's archive, and archives with reproducible bytes."""
