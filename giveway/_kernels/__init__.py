"""Compiled kernels: their compilation, their linking and their cache."""
