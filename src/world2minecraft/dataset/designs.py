"""Which furniture design each block of a scene is part of, from what lies beside its world.

A generated world has them in ``scene.npz`` (``design``) and ``designs.json``; a run of ours knows
the template of each object.
"""

from pathlib import Path

import numpy as np

from world2minecraft.errors import DamagedFileError
from world2minecraft.exchange.forms import templates_of_run
from world2minecraft.exchange.labelled import common_cells
from world2minecraft.exchange.scene import read_scene
from world2minecraft.files import array_names, read_json, read_npz
from world2minecraft.types import BlockVolume

NAMES_FILE = "designs.json"
MOST = 0xFFFF


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
    if "design" in array_names(folder / "scene.npz"):
        return _stored(folder, volume)
    templates = templates_of_run(folder.parent) or templates_of_run(folder)
    if not templates:
        return none, ("",)
    names = ("", *sorted(set(templates.values())))
    table = np.zeros(int(max(volume.instance.max(initial=0), *templates)) + 1, np.uint16)
    for number, template in templates.items():
        table[number] = names.index(template)
    return np.where(volume.states > 0, table[volume.instance], 0).astype(np.uint16), names


def _stored(folder: Path, volume: BlockVolume) -> tuple[np.ndarray, tuple[str, ...]]:
    source = folder / NAMES_FILE
    raw = read_json(source)
    if not isinstance(raw, list) or len(raw) > MOST or not all(isinstance(n, str) for n in raw):
        raise DamagedFileError(source, "must be a list of names of designs")
    names = tuple(raw) if raw[:1] == [""] else ("", *raw)
    design = read_npz(folder / "scene.npz", ("design",))["design"]
    scene = read_scene(folder)
    if design.shape != scene.semantic.shape or design.dtype != np.uint16:
        raise DamagedFileError(folder / "scene.npz", "design must be uint16 in semantic's shape")
    if design.size and int(design.max()) >= len(names):
        raise DamagedFileError(source, f"has {len(names)} names; scene.npz goes to {design.max()}")
    ours, theirs = common_cells(volume, scene)
    result = np.zeros(volume.states.shape, np.uint16)
    result[ours] = np.where(volume.states[ours] > 0, design[theirs], 0)
    return result, names
