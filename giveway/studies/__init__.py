"""Studies: thousands of paired runs, planned, computed, kept and compared.

A study file names factors and their levels. Every combination of levels is a cell, and every cell
is run with the same seeds, so that each controller meets the same crowds.
"""
