"""The probability of an event in a scenario: random inputs, estimators, severity."""
