"""Which furniture design each block of a scene is part of, from what lies beside its world.

A generated world says so in its scene; a run of ours knows the template of each object.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.scene import read_scene
from world2minecraft.formats.volume_formats import common_cells, templates_of_run


def designs_beside(folder: Path | None, volume: BlockVolume) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the design of each block of a volume, uint16 [X, Y, Z], and their names.

    Number 0 stands for none; its name is empty.

    Args:
        folder: that of the ``scene.json``, or None.
        volume: the blocks.

    Raises:
        DamagedFileError: designs are there and cannot be read.
    """
    none = np.zeros(volume.states.shape, np.uint16)
    if folder is None or not (folder / "scene.npz").is_file():
        return none, ("",)
    scene = read_scene(folder)
    if scene.design is not None:
        ours, theirs = common_cells(volume, scene)
        none[ours] = np.where(volume.states[ours] > 0, scene.design[theirs], 0)
        return none, scene.designs
    return _of_run(volume, templates_of_run(folder.parent))


def _of_run(
    volume: BlockVolume, templates: Mapping[int, str]
) -> tuple[np.ndarray, tuple[str, ...]]:
    names = ("", *sorted(set(templates.values())))
    most = max([int(volume.instance.max(initial=0)), *templates])
    table = np.zeros(most + 1, np.uint16)
    for number, template in templates.items():
        table[number] = names.index(template)
    return np.where(volume.states > 0, table[volume.instance], 0).astype(np.uint16), names
