"""What an agent saw on its walk: the views that it kept, or the same ones drawn again."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import read_colour
from world2minecraft.core.errors import InputError
from world2minecraft.navigation.running.scene_ground import SceneGround
from world2minecraft.navigation.running.trace import (
    TRACE_FILE,
    VIEWS_FOLDER,
    read_trace,
    stances_of,
    traces_in,
)
from world2minecraft.navigation.scene import open_scene


def views_of_walk(run: Path, walk: Path, most: int) -> list[np.ndarray]:
    """Return what an agent saw, uint8 [H, W, 3] each, the first and the last among it.

    Agents that look keep their views. Of those that know the scene, as the oracle, they are drawn
    from where they stood.

    Args:
        run: the reconstruction that was walked in.
        walk: the folder of one walk of ``w2m vln run``.
        most: how many views are wanted; a short walk has fewer.

    Raises:
        InputError: the folder holds no walk, or several. DamagedFileError: its trace is none.
    """
    kept = sorted((walk / VIEWS_FOLDER).glob("*.jpg"))
    if kept:
        return [read_colour(kept[n]) for n in spread(len(kept), most)]
    traces = traces_in(walk)
    if not traces[0].is_file():
        raise InputError(walk, "holds no walk; name a folder of w2m vln run")
    if traces[0].parent != walk:
        raise InputError(walk, f"holds {len(traces)} walks; name one, such as {traces[0].parent}")
    stances = stances_of(read_trace(walk / TRACE_FILE), walk / TRACE_FILE)
    ground = SceneGround(open_scene(run))
    return [ground.view(stances[n]) for n in spread(len(stances), most)]


def spread(count: int, most: int) -> Sequence[int]:
    """Return up to ``most`` numbers below ``count``, evenly apart, the first and last among them.

    Example:
        >>> spread(10, 4)
        [0, 3, 6, 9]
        >>> spread(2, 4)
        [0, 1]
    """
    taken = min(count, most)
    return [n * (count - 1) // max(taken - 1, 1) for n in range(taken)]
