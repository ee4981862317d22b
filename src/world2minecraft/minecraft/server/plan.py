"""What is to be said to a server so that a volume stands there, in order."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_entities import in_game
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.commands.writer import (
    air_commands,
    block_commands,
    chunk_rows,
    data_commands,
    entity_commands,
    entity_tag,
    state_in_version,
)
from world2minecraft.minecraft.losses import Losses
from world2minecraft.minecraft.server.rcon import MAX_COMMAND_BYTES
from world2minecraft.minecraft.versions import GameVersion

PROBE_STEP = 64  # Blocks between the places at which it is asked whether chunks are loaded.
Probe = tuple[int, int, int, str]  # x, y, z and what must be there of a state
# What games work out anew from whatever stands beside a block, in the volume or outside it.
_FROM_NEIGHBOURS = frozenset(
    [
        *("north", "east", "south", "west", "up", "down", "shape", "in_wall", "waterlogged"),
        *("distance", "bottom", "snowy", "signal_fire", "instrument", "occupied", "powered"),
        *("power", "lit", "triggered", "extended", "attached", "disarmed"),
    ]
)
_CHESTS = ("minecraft:chest", "minecraft:trapped_chest")  # Whose type says what it joins.


@dataclass(frozen=True)
class BuildPlan:
    """Commands by phase. Whatever was run twice in its order leaves the same blocks.

    load, release: forceload of the chunks, and its end.
    loaded: places (x, y, z) all of which must be loaded before anything is set.
    work: what empties and sets blocks, their data and the entities, in order.
    entities_from: the index in ``work`` from which entities are set: these would be doubled when
        run twice, so it begins with the command that takes them away.
    probes: what must be there in the end.
    """

    load: tuple[str, ...]
    loaded: tuple[tuple[int, int, int], ...]
    work: tuple[str, ...]
    entities_from: int
    probes: tuple[Probe, ...]
    release: tuple[str, ...]

    @property
    def digest(self) -> str:
        """What two plans share that do the same: the SHA-256 of their work."""
        return hashlib.sha256("\n".join(self.work).encode()).hexdigest()


def plan_build(
    volume: BlockVolume,
    version: GameVersion,
    *,
    built: np.ndarray | None = None,
    samples: int = 256,
    losses: Losses | None = None,
) -> BuildPlan:
    """Return what builds a volume at its own world position.

    Args:
        volume: the blocks.
        version: the game of the server, for the names of blocks.
        built: bool [X, Y, Z], the cells that are set, air among them; all where it is left out.
        samples: how many of its blocks to ask for in the end; half of them not air. The places
            depend on the volume alone.
        losses: told of data and entities that are too long for a command.

    Raises:
        UsageError: a state or an entity's id is none, or the box leaves the world's layers.
    """
    _check_layers(volume, version)
    volume = in_game(volume, version.data_version)
    lost = Losses() if losses is None else losses
    air = (volume.states == 0) & (True if built is None else built)
    blocks = [*air_commands(volume, air), *block_commands(volume, version)]
    data = _short("block entities whose data is too long for RCON", data_commands(volume), lost)
    entities = _short("entities too long for RCON", entity_commands(volume), lost)
    gone = [f"kill @e[tag={entity_tag(volume)}]"] if entities else []
    rows = chunk_rows(volume)
    return BuildPlan(
        load=tuple(f"forceload add {row}" for row in rows),
        loaded=_corners(volume),
        work=(*blocks, *data, *gone, *entities),
        entities_from=len(blocks) + len(data),
        probes=_probes(volume, version, samples, air),
        release=tuple(f"forceload remove {row}" for row in rows),
    )


def _check_layers(volume: BlockVolume, version: GameVersion) -> None:
    low, high = volume.corner[1], volume.corner[1] + volume.states.shape[1] - 1
    if low < version.min_y or high > version.max_y:
        raise UsageError(
            f"the build reaches from layer {low} to {high}, but the world has {version.min_y} to "
            f"{version.max_y}; choose another --at or fewer blocks per metre"
        )


def _short(what: str, commands: Sequence[str], losses: Losses) -> list[str]:
    kept = [command for command in commands if len(command.encode()) <= MAX_COMMAND_BYTES]
    losses.add(what, len(commands) - len(kept))
    return kept


def _corners(volume: BlockVolume) -> tuple[tuple[int, int, int], ...]:
    """Return the corners of the box's plan and places between them, one a few chunks."""
    x, y, z = volume.corner
    x1, z1 = x + volume.states.shape[0] - 1, z + volume.states.shape[2] - 1
    xs = sorted({*range(x, x1, PROBE_STEP), x1})
    zs = sorted({*range(z, z1, PROBE_STEP), z1})
    return tuple((px, y, pz) for px in xs for pz in zs)


def lasting_state(state: str) -> str:
    """Return a state without the properties that the blocks around it may change at once.

    Example:
        >>> lasting_state("minecraft:oak_stairs[facing=east,half=top,shape=inner_left]")
        'minecraft:oak_stairs[facing=east,half=top]'
    """
    parsed = parse_state(state)
    dropped = _FROM_NEIGHBOURS | ({"type"} if parsed.name in _CHESTS else set())
    kept = {key: value for key, value in parsed.properties if key not in dropped}
    return str(BlockState(parsed.name, kept))


def _probes(
    volume: BlockVolume, version: GameVersion, samples: int, air: np.ndarray
) -> tuple[Probe, ...]:
    rng = np.random.default_rng(0)
    flat = volume.states.ravel()
    chosen = []
    for kind in (
        np.flatnonzero(flat),
        np.flatnonzero(air),
    ):
        count = min(len(kind), samples // 2)
        chosen.append(np.sort(rng.choice(kind, count, replace=False)) if count else kind[:0])
    names = [state_in_version(lasting_state(state), version) for state in volume.palette]
    cells = np.column_stack(np.unravel_index(np.concatenate(chosen), volume.states.shape))
    places = (cells + np.array(volume.corner)).tolist()
    return tuple(
        (x, y, z, names[volume.states[tuple(cell)]])
        for (x, y, z), cell in zip(places, cells.tolist(), strict=True)
    )
