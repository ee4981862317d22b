"""Speed and memory against the budgets: ``python -m benchmarks`` runs every ``bench_*.py``."""
