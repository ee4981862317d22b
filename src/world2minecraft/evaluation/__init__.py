"""Evaluation: metrics, scores of reconstructions against ground truth, and reports."""
