"""Compiled kernels: how they are linked, and where they are kept."""
