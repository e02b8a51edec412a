"""The model predictive controller of Yang & Özgüner 2019."""
