"""The same people without the ego: the counterfactual run that delays are measured against."""
