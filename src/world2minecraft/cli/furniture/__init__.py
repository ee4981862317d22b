"""``w2m furniture``: the furniture library."""
