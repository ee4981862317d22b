"""Resources of this machine."""

import os


def usable_cores() -> int:
    """Return how many cores this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):  # Only Linux reports limits.
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1
