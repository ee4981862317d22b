"""The verbs ``w2m compare ...``, which compare rooms with those of other methods."""
