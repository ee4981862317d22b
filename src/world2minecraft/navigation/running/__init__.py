"""Running of agents: episodes, items, traces, videos, scores and result tables."""
