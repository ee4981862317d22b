"""Models that nobody would make, from a seed: boxes that are turned, flat, hollow or perforated.

They are what a renderer may get wrong, all in one volume: ``odd_volume(seed)`` with the looks
``OddLooks(seed)``.
"""

import numpy as np

from world2minecraft.coordinates import block_to_room
from world2minecraft.render.elements import BlockModel, Element, FaceLook, face_uv
from world2minecraft.render.texture import Texture
from world2minecraft.types import BlockVolume

KINDS = 24
NAMES = ("solid", "holes", "glass", "frame")
SIDE_PX = 16
AXIS_TURNS_DEG = (-45.0, -22.5, 22.5, 45.0, 90.0)


class OddLooks:
    """Models of the states ``odd:0`` to ``odd:23``; the textures ``solid holes glass frame``."""

    def __init__(self, seed: int = 0):
        rng = np.random.default_rng(seed)
        solid = rng.integers(40, 255, (SIDE_PX, SIDE_PX, 4)).astype(np.uint8)
        solid[..., 3] = 255
        holes, glass, frame = solid.copy(), solid.copy(), solid.copy()
        holes[..., 3] = np.where(rng.random((SIDE_PX, SIDE_PX)) < 0.4, 0, 255)
        glass[..., 3] = 90
        frame[2:-2, 2:-2, 3] = 0
        self._textures = {
            "solid": Texture(solid),
            "holes": Texture(holes),
            "glass": Texture(glass, translucent=True),
            "frame": Texture(frame),
        }
        self._models = {f"odd:{n}": BlockModel(_elements(n, rng)) for n in range(KINDS)}

    def model(self, state: str) -> BlockModel | None:
        """Return a state's model."""
        return self._models.get(state)

    def texture(self, name: str) -> Texture | None:
        """Return a texture."""
        return self._textures.get(name)


def odd_volume(seed: int, shape: tuple[int, int, int] = (9, 8, 10), share: float = 0.25):
    """Return a volume with a ``share`` of its cells filled with any of the odd states."""
    rng = np.random.default_rng([seed, 1])
    states = np.where(rng.random(shape) < share, rng.integers(1, KINDS + 1, shape), 0)
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=("minecraft:air", *(f"odd:{n}" for n in range(KINDS))),
        semantic=np.where(states > 0, 10, 0).astype(np.uint8),
        instance=states.astype(np.uint16),
        corner=(-3, 60, 5),
        block_to_room=block_to_room(np.array([0.5, 2.0]), 2.0),
    )


def _elements(number: int, rng: np.random.Generator) -> tuple[Element, ...]:
    """Return a full cube of each texture, then lists of boxes."""
    if number < len(NAMES):
        return (_box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), NAMES[number], None, rng, 1.0),)
    return tuple(_random_box(rng) for _ in range(int(rng.integers(1, 6))))


def _random_box(rng: np.random.Generator) -> Element:
    """Return a box in sixteenths, now and then flat, turned or without some of its faces."""
    ends = np.sort(rng.integers(0, 17, (2, 3)), axis=0) / 16
    ends[1] = np.where(ends[1] == ends[0], np.minimum(ends[0] + 0.125, 1.0), ends[1])
    if rng.random() < 0.2:
        axis = rng.integers(3)
        ends[1, axis] = ends[0, axis]
    turn = None
    if rng.random() < 0.4:
        ends = 0.5 + (ends - 0.5) * 0.55  # So that it stays in its block whichever way it turns.
        turn = _turn(rng)
    name = NAMES[int(rng.integers(len(NAMES)))]
    shown = 1.0 if rng.random() < 0.7 else 0.6
    return _box(tuple(ends[0].tolist()), tuple(ends[1].tolist()), name, turn, rng, shown)


def _box(low, high, name: str, turn, rng: np.random.Generator, shown: float) -> Element:
    faces = tuple(
        FaceLook(name, face_uv(side, low, high, rotation_deg=90 * int(rng.integers(4))))
        if rng.random() < shown
        else None
        for side in range(6)
    )
    return Element(low, high, faces, turn)


def _turn(rng: np.random.Generator) -> np.ndarray:
    """Return a turn about the block's middle: about an axis as model files have it, or any."""
    from scipy.spatial.transform import Rotation

    if rng.random() < 0.5:
        axis = "xyz"[int(rng.integers(3))]
        turning = Rotation.from_euler(axis, float(rng.choice(AXIS_TURNS_DEG)), degrees=True)
    else:
        turning = Rotation.random(rng=rng)
    turn = np.eye(4)
    turn[:3, :3] = turning.as_matrix()
    turn[:3, 3] = 0.5 - turn[:3, :3] @ np.full(3, 0.5)
    return turn
