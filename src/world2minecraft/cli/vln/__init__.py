"""``w2m vln``: navigation sets, agents and their scores."""
