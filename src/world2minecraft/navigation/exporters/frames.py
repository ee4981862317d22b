"""World blocks to the metres of Habitat: y up, x east, z south, where our exported stages stand.

A stage of ``w2m convert SCENE NAME.habitat`` stands by the scene's own ``block_to_room``, which is
read from the ``scene.json`` beside its blocks. A place that has none is taken from its world's
origin, by the length of a block.
"""

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import ROOM_AXES_TO_BLOCK, apply
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json
from world2minecraft.navigation.records import scene_place
from world2minecraft.navigation.values import Stance

SCENE_FILE = "scene.json"


def block_to_habitat(scene: str, set_folder: Path, metres_per_block: float) -> np.ndarray:
    """Return the 4x4 from world blocks to a scene's stage in Habitat.

    Args:
        scene: the path that an episode says, see ``scene_place``.
        set_folder: of the set.
        metres_per_block: of a scene without a ``scene.json``.

    Raises:
        DamagedFileError: there is a ``scene.json``, and it says no transform.
    """
    place = scene_place(scene, set_folder)
    for folder in (place, place / "build", place.parent):
        if (folder / SCENE_FILE).is_file():
            room_to_habitat = np.eye(4)
            room_to_habitat[:3, :3] = ROOM_AXES_TO_BLOCK
            return room_to_habitat @ _block_to_room(folder / SCENE_FILE)
    return np.diag([metres_per_block] * 3 + [1.0])


def positions(to_habitat: np.ndarray, feet: Iterable[tuple[float, float, float]]) -> list:
    """Return places in Habitat's metres, to a tenth of a millimetre, as JSON has them."""
    points = np.array(list(feet), np.float64).reshape(-1, 3)
    return (np.round(apply(to_habitat, points), 4) + 0.0).tolist()


def rotation(stance: Stance) -> list[float]:
    """Return a heading as Habitat's quaternion x, y, z, w about y; unturned one looks to -z.

    Example:
        >>> rotation(Stance(0, 0, 0, yaw_deg=180.0))  # North.
        [0.0, 0.0, 0.0, 1.0]
    """
    half = math.radians(180.0 - stance.yaw_deg) / 2
    return [0.0, round(math.sin(half), 6) + 0.0, 0.0, round(math.cos(half), 6) + 0.0]


def _block_to_room(path: Path) -> np.ndarray:
    try:
        transform = np.array(read_json(path)["block_to_room"], np.float64)
        if transform.shape != (4, 4) or not np.isfinite(transform).all():
            raise ValueError(f"has shape {transform.shape}, or is not finite")
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"block_to_room must be a 4 x 4 ({error})") from error
    return transform
