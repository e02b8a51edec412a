"""The code of other packages: finding it, loading it, and reading its options."""
