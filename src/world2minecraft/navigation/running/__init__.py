"""Runs: episodes walked and items answered, with traces, films, scores and tables."""
