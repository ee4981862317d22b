"""The verbs ``w2m evaluate ...``, which score reconstructions and networks."""
