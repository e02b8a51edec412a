"""The recording of a run's rows, step by step, in a file that survives a crash."""
