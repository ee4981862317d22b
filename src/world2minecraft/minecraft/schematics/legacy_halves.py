"""Blocks of two parts as they were before 1.13: what one part said, the other did not.

The lower half of a door knew where it faces and whether it is open, the upper its hinge; of a
tall plant only the lower half knew its kind; two chests side by side were one.
"""

from collections.abc import Callable

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, parse_state

_PLANTS = ("sunflower", "lilac", "tall_grass", "large_fern", "rose_bush", "peony")
PLANTS = tuple(f"minecraft:{name}" for name in _PLANTS)
CHESTS = ("minecraft:chest", "minecraft:trapped_chest")
# Where the right half of a chest stands, seen from its left half: steps along x and z.
RIGHT_HALF = {"north": (1, 0), "east": (0, 1), "south": (-1, 0), "west": (0, -1)}
Palette = tuple[str, ...]
Pair = tuple[BlockState, BlockState]


def join_halves(states: np.ndarray, palette: Palette) -> tuple[np.ndarray, Palette]:
    """Return the volume with both parts of doors, tall plants and chests told of each other.

    Args:
        states: uint16 [X, Y, Z] in block axes, changed in place.
        palette: its states.
    """
    growing = list(palette)
    parsed = [parse_state(text) for text in palette]
    _join(states, growing, _are(parsed, _is_door, "lower"), _are(parsed, _is_door, "upper"), _door)
    _join(
        states, growing, _are(parsed, _is_plant, "lower"), _are(parsed, _is_plant, "upper"), _plant
    )
    _join_chests(states, growing, parsed)
    return states, tuple(growing)


def _is_door(state: BlockState) -> bool:
    return state.name.endswith("_door")


def _is_plant(state: BlockState) -> bool:
    return state.name in PLANTS


def _are(parsed: list[BlockState], kind: Callable[[BlockState], bool], half: str) -> np.ndarray:
    return np.array([kind(state) and state.get("half") == half for state in parsed])


def _door(lower: BlockState, upper: BlockState) -> Pair:
    said = {"hinge": upper.get("hinge"), "powered": upper.get("powered")}
    lower = lower.having(**said)
    return lower, lower.having(half="upper")


def _plant(lower: BlockState, upper: BlockState) -> Pair:
    return lower, lower.having(half="upper")


def _join(
    states: np.ndarray,
    palette: list[str],
    is_lower: np.ndarray,
    is_upper: np.ndarray,
    join: Callable[[BlockState, BlockState], Pair],
) -> None:
    """Change every lower part with an upper one above it, and that one."""
    if not (is_lower.any() and is_upper.any()):
        return
    known = len(is_lower)  # States that were added since are finished.
    numbers = np.minimum(states, known - 1)
    is_pair = (is_lower[numbers] & (states < known))[:, :-1] & is_upper[numbers][:, 1:]
    x, y, z = np.nonzero(is_pair)
    if not len(x):
        return
    both = states[x, y, z].astype(np.int64) << 16 | states[x, y + 1, z]
    kinds, which = np.unique(both, return_inverse=True)
    found = []
    for kind in kinds.tolist():
        parts = join(parse_state(palette[kind >> 16]), parse_state(palette[kind & 0xFFFF]))
        found.append([_number(palette, str(part)) for part in parts])
    new = np.array(found, np.uint16)[which.ravel()]
    states[x, y, z], states[x, y + 1, z] = new[:, 0], new[:, 1]


def _join_chests(states: np.ndarray, palette: list[str], parsed: list[BlockState]) -> None:
    for number, state in enumerate(parsed):
        if state.name not in CHESTS or state.get("type") != "single":
            continue
        step_x, step_z = RIGHT_HALF[state.get("facing")]
        right = _number(palette, str(state.having(type="right")))
        left = _number(palette, str(state.having(type="left")))
        cells = {tuple(cell) for cell in np.argwhere(states == number).tolist()}
        for x, y, z in sorted(cells):
            other = (x + step_x, y, z + step_z)
            if (x, y, z) in cells and other in cells:
                states[x, y, z], states[other] = left, right
                cells -= {(x, y, z), other}


def _number(palette: list[str], text: str) -> int:
    if text not in palette:
        palette.append(text)
    return palette.index(text)
