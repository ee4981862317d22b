"""Whether two trees of NBT values are the same, arrays among them."""

import numpy as np


def same(a, b) -> bool:
    """Whether values and their tags agree."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return type(a) is type(b) and a.dtype == b.dtype and np.array_equal(a, b)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(same, a, b))
    return type(a) is type(b) and (a == b or (a != a and b != b))


def same_block_entities(a, b) -> bool:
    """Whether two volumes hold the same block entities, in any order."""
    first, second = ({e.block_pos: (e.id, dict(e.nbt)) for e in v.block_entities} for v in (a, b))
    return same({str(k): v for k, v in first.items()}, {str(k): v for k, v in second.items()})


def same_entities(a, b, places: float = 1e-9) -> bool:
    """Whether two volumes hold the same entities; places may differ by rounding."""
    if len(a.entities) != len(b.entities):
        return False
    return all(
        first.id == second.id
        and np.allclose(first.position, second.position, rtol=0, atol=places)
        and same(dict(first.nbt), dict(second.nbt))
        for first, second in zip(a.entities, b.entities, strict=True)
    )
