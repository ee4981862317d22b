"""Benchmarks of speed (bench_*) and quality (check_*): ``python -m benchmarks --list``."""
