"""The verbs ``w2m vln ...`` for navigation sets, agents and scores."""
