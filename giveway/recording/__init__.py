"""Rows gathered step by step, and kept where a crash cannot take them along."""
