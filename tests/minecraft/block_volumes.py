"""Volumes that the tests of this folder share."""

from functools import cache

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_states import known_blocks, states_of
from world2minecraft.minecraft.nbt import Byte, Float


@cache
def every_state() -> list[str]:
    return [str(state) for name in known_blocks() for state in states_of(name)]


def some_states(count: int, seed: int) -> tuple[str, ...]:
    """Different states of the game's table, none of them air."""
    rng = np.random.default_rng(seed)
    every = every_state()
    picked = rng.choice(len(every), count, replace=False)
    return tuple(every[index] for index in sorted(picked) if every[index] != AIR)


def volume_of(
    states: np.ndarray, palette: tuple[str, ...], corner: tuple[int, int, int], **held
) -> BlockVolume:
    """A volume without labels, at four blocks a metre."""
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=palette,
        semantic=np.zeros(states.shape, np.uint8),
        instance=np.zeros(states.shape, np.uint16),
        corner=corner,
        block_to_room=block_to_room(np.array([0.0, 3.0]), 4.0),
        **held,
    )


def random_volume(
    shape: tuple[int, int, int], kinds: int, corner: tuple[int, int, int], seed: int = 0
) -> BlockVolume:
    """Air, runs of blocks and noise; its palette has a mod's block too."""
    rng = np.random.default_rng(seed)
    palette = (AIR, "tmeo_ultra:shafa_1x_2[facing=east]", *some_states(kinds, seed))
    states = np.zeros(shape, np.uint16)
    for _ in range(6):
        low = rng.integers(0, shape)
        high = low + rng.integers(1, np.array(shape) + 1)
        states[tuple(map(slice, low, high))] = rng.integers(0, len(palette))
    noise = rng.random(shape) < 0.2
    states[noise] = rng.integers(0, len(palette), noise.sum())
    states[0, 0, 0] = states[-1, -1, -1] = 1  # So that the box of all blocks is the whole.
    return volume_of(states, palette, corner)


def furnished_volume() -> BlockVolume:
    """A small room with a sign, a chest and a display entity in it."""
    palette = (
        AIR,
        "minecraft:oak_planks",
        "minecraft:oak_wall_sign[facing=south,waterlogged=false]",
        "minecraft:chest[facing=north,type=single,waterlogged=false]",
    )
    states = np.zeros((7, 4, 6), np.uint16)
    states[:, 0] = 1
    states[3, 1, 2], states[4, 1, 3] = 2, 3
    text = {"messages": ['{"text":"it\'s a \\"room\\""}', '""', '""', '""'], "color": "black"}
    return volume_of(
        states,
        palette,
        (-3, 63, -2),
        block_entities=(
            BlockEntity((0, 64, 0), "minecraft:sign", {"front_text": text, "is_waxed": Byte(1)}),
            BlockEntity((1, 64, 1), "minecraft:chest", {"Items": []}),
        ),
        entities=(
            Entity(
                (-1.25, 64.5, 2.75),
                "minecraft:block_display",
                {
                    "block_state": {"Name": "minecraft:stone"},
                    "Rotation": [Float(90), Float(0)],
                    "brightness": {"sky": 15, "block": 15},
                },
            ),
        ),
    )


def state_texts(volume: BlockVolume) -> np.ndarray:
    """The state of every cell as text [X, Y, Z]: what two volumes must agree on."""
    return np.array(volume.palette)[volume.states]
