"""What a format could not carry: readers and writers tell, `w2m convert` prints it."""

from collections import Counter
from collections.abc import Iterator


class Losses:
    """Counts of what was left behind on the way from one format to another, by what it is.

    Example:
        >>> losses = Losses()
        >>> losses.add("entities", 3)
        >>> losses.add("entities", 1)
        >>> list(losses)
        [('entities', 4)]
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()

    def add(self, what: str, count: int = 1) -> None:
        """Count ``count`` more of what was lost; 0 or less counts nothing.

        Args:
            what: a plural, as in ``3 entities``, with its reason where it is not plain.
            count: how many.
        """
        if count > 0:
            self._counts[what] += count

    def __iter__(self) -> Iterator[tuple[str, int]]:
        return iter(sorted(self._counts.items()))

    def __len__(self) -> int:
        return len(self._counts)
