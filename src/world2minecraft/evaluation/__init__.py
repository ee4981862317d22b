"""Scores: metrics, reconstructions against their truth, and the fidelity report."""
