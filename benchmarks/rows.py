"""One measured figure of a benchmark, for the table of ``python -m benchmarks``.

A benchmark is a file ``bench_NAME.py`` with a function ``run() -> list[Row]``. It runs in a process
of its own, so that its peak memory is measured separately.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """One figure. Smaller is better, unless the unit is a rate (it ends in ``/s``)."""

    what: str
    value: float
    unit: str
    budget: float | None = None
    rival: str | None = None
    ratio: float | None = None  # How many times better than the rival in the same run.
    peak_mb: float | None = None

    @property
    def is_rate(self) -> bool:
        """Whether more is better."""
        return self.unit.endswith("/s")

    @property
    def is_within_budget(self) -> bool | None:
        """Whether the budget is met; None where there is no budget."""
        if self.budget is None:
            return None
        return self.value >= self.budget if self.is_rate else self.value <= self.budget
