"""The verbs ``w2m furniture ...`` of the furniture library."""
