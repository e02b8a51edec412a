"""Rows gathered step by step, and kept where they outlive a crash."""
