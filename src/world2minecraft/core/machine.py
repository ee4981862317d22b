"""Resources of this machine."""

import os


def usable_cores() -> int:
    """Return the number of cores that this process can use, at least 1."""
    if hasattr(os, "sched_getaffinity"):  # Only Linux reports limits.
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1
