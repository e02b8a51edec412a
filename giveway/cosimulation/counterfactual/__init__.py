"""The counterfactual run: the same people without the ego, against which delays are measured."""
