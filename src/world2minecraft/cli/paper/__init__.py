"""``w2m paper``: the tables and figures of the paper."""
