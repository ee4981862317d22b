"""``w2m evaluate``: scores of reconstructions and of networks."""
