"""Benchmark of real captures: reconstruct every room of the shared inputs and score the results."""
