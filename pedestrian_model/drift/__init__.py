"""The predictor ``drift``: constant velocity, corrected by what people did in the last seconds."""
