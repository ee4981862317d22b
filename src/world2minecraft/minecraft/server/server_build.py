"""Building of a volume on a running server, with reconnection and a check of the result.

A plan lists the commands in order. Progress is saved in a small file, so that a second run resumes
where the first one stopped.
"""

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import MALFORMED, InputError, ServerError, UsageError, one_line
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.commands.writer import (
    air_commands,
    block_commands,
    chunk_rows,
    data_commands,
    entity_commands,
    entity_tag,
    probe_columns,
    state_in_version,
)
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.server.rcon import MAX_COMMAND_BYTES, RconClient
from world2minecraft.minecraft.versions import GameVersion

# What games compute again from the neighbours of a block, in the volume or outside it.
_FROM_NEIGHBOURS = frozenset(
    [
        *("north", "east", "south", "west", "up", "down", "shape", "in_wall", "waterlogged"),
        *("distance", "bottom", "snowy", "signal_fire", "instrument", "occupied", "powered"),
        *("power", "lit", "triggered", "extended", "attached", "disarmed"),
    ]
)
_CHESTS = ("minecraft:chest", "minecraft:trapped_chest")  # Whose type says what it joins.
NOTE_EVERY_S = 0.5
LOAD_TRIES, LOAD_WAIT_S = 60, 0.5  # Half a minute for the chunks to come.
RETRIES, FIRST_WAIT_S, MAX_WAIT_S = 6, 0.5, 8.0  # Half a minute for a server to come back.
SHOWN = 3  # So many wrong blocks are named.
# Replies to a command that was wrong; replies to one that changed nothing are fine.
_SYNTAX_ERROR = "<--[HERE]"
_WRONG = (
    _SYNTAX_ERROR,
    "Unknown ",
    "Incorrect ",
    "Invalid ",
    "Expected ",
    "Too many blocks",
    "An unexpected error",
    "out of this world",
    "outside of the world",
)
_NOT_LOADED = "not loaded"
_WERE_LOADED = "No chunks were marked"
_PASSED, _FAILED = "Test passed", "Test failed"


Probe = tuple[int, int, int, str]  # x, y, z and the expected block state.


@dataclass(frozen=True)
class BuildPlan:
    """The commands of a build by phase. Running commands twice in order gives the same blocks.

    Attributes:
        load: Commands that force-load the chunks.
        loaded: Positions (x, y, z) that must be loaded before any block is set.
        work: Commands that clear and set blocks, block data and entities, in order.
        entities_from: The index in ``work`` from which entities are placed. Running these commands
            twice would duplicate entities, so the first one removes existing entities.
        probes: The blocks to check at the end.
        release: Commands that release the chunks.
    """

    load: tuple[str, ...]
    loaded: tuple[tuple[int, int, int], ...]
    work: tuple[str, ...]
    entities_from: int
    probes: tuple[Probe, ...]
    release: tuple[str, ...]

    @property
    def digest(self) -> str:
        """The SHA-256 hash of the ``work`` commands, which is equal for equivalent plans."""
        return hashlib.sha256("\n".join(self.work).encode()).hexdigest()


def plan_build(
    volume: BlockVolume,
    version: GameVersion,
    *,
    built: np.ndarray | None = None,
    samples: int = 256,
    losses: Losses | None = None,
) -> BuildPlan:
    """Plan the commands that build a volume at its own world position.

    Args:
        volume: The blocks to build.
        version: The game version of the server, which determines block names.
        built: The cells to set, including air, as bool [X, Y, Z]. The default is all cells.
        samples: Number of blocks to check at the end, half of them not air. The positions depend
            only on the volume.
        losses: Counts of block data and entities that are too long for a command.

    Raises:
        UsageError: If a block state or an entity ID is invalid, or the volume exceeds the height
            limits of the world.
    """
    _check_layers(volume, version)
    volume = convert_volume(volume, version.data_version)
    lost = Losses() if losses is None else losses
    air = (volume.states == 0) & (True if built is None else built)
    blocks = [*air_commands(volume, air), *block_commands(volume, version)]
    data = _drop_long_commands(
        "block entities whose data is too long for RCON", data_commands(volume), lost
    )
    entities = _drop_long_commands("entities too long for RCON", entity_commands(volume), lost)
    gone = [f"kill @e[tag={entity_tag(volume)}]"] if entities else []
    rows = chunk_rows(volume)
    return BuildPlan(
        load=tuple(f"forceload add {row}" for row in rows),
        loaded=tuple((x, volume.corner[1], z) for x, z in probe_columns(volume)),
        work=(*blocks, *data, *gone, *entities),
        entities_from=len(blocks) + len(data),
        probes=_probes(volume, version, samples, air),
        release=tuple(f"forceload remove {row}" for row in rows),
    )


def _check_layers(volume: BlockVolume, version: GameVersion) -> None:
    low, high = volume.corner[1], volume.corner[1] + volume.states.shape[1] - 1
    if low < version.min_y or high > version.max_y:
        raise UsageError(
            f"the build has layers {low} to {high}, but the world has layers {version.min_y} to "
            f"{version.max_y}; choose another position (--at) or fewer blocks per metre"
        )


def _drop_long_commands(what: str, commands: Sequence[str], losses: Losses) -> list[str]:
    short = [command for command in commands if len(command.encode()) <= MAX_COMMAND_BYTES]
    losses.add(what, len(commands) - len(short))
    return short


def lasting_state(state: str) -> str:
    """Return a block state without the properties that neighbouring blocks can change.

    Example:
        >>> lasting_state("minecraft:oak_stairs[facing=east,half=top,shape=inner_left]")
        'minecraft:oak_stairs[facing=east,half=top]'
    """
    parsed = parse_state(state)
    dropped = _FROM_NEIGHBOURS | ({"type"} if parsed.name in _CHESTS else set())
    lasting = {key: value for key, value in parsed.properties if key not in dropped}
    return str(BlockState(parsed.name, lasting))


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


@dataclass(frozen=True)
class LiveResult:
    """The counts of a build: commands, reconnections, checked blocks and repaired blocks."""

    commands: int
    reconnects: int
    checked: int
    repaired: int


class LiveBuilder:
    """A builder that runs a build plan on one server, with reconnection and a final check.

    Args:
        client: The RCON client. It connects when the build starts.
        plan: The commands to run.
        note: The file that stores the progress. With None, progress is not stored.
        progress: Callback that receives the number of finished commands.
        sleep: Function that waits for a number of seconds.
    """

    def __init__(
        self,
        client: RconClient,
        plan: BuildPlan,
        note: Path | None = None,
        progress: Progress = no_progress,
        sleep: Callable[[float], None] = time.sleep,
    ):
        self._client, self._plan, self._note = client, plan, note
        self._progress, self._sleep = progress, sleep
        self._commands = self._reconnects = self._done = 0
        self._connected = self._was_there = False
        self._noted_at = 0.0
        self._to_release: tuple[str, ...] = plan.release

    def run(self) -> LiveResult:
        """Build the volume, check it and repair wrong blocks.

        Raises:
            ServerError: If the server cannot be reached, rejects a command, does not load the
                chunks or does not have the expected blocks at the end. Progress is saved for a
                second run.
        """
        try:
            self._done = self._read_note()
            self._load()
            for index in range(self._done, len(self._plan.work)):
                self._progress("build", index, len(self._plan.work))
                self._run(self._plan.work[index])
                self._set_done(index + 1)
            self._progress("build", len(self._plan.work), len(self._plan.work))
            repaired = self._check()
            for command in self._to_release:
                self._send(command)
        except BaseException:
            self._write_note()
            raise
        finally:
            self._client.close()
        if self._note is not None:
            self._note.unlink(missing_ok=True)
        return LiveResult(self._commands, self._reconnects, len(self._plan.probes), repaired)

    def _load(self) -> None:
        """Force-load the chunks and wait for them. Chunks loaded before stay loaded."""
        replies = [self._send(command) for command in self._plan.load]
        if not self._done:
            rows = zip(replies, self._plan.release, strict=True)
            self._to_release = tuple(row for reply, row in rows if _WERE_LOADED not in reply)
        for done, (x, y, z) in enumerate(self._plan.loaded):
            self._progress("load", done, len(self._plan.loaded))
            self._wait_for(x, y, z)
        self._progress("load", len(self._plan.loaded), len(self._plan.loaded))

    def _wait_for(self, x: int, y: int, z: int) -> None:
        for _ in range(LOAD_TRIES):
            if self._is_loaded(x, y, z):
                return
            self._sleep(LOAD_WAIT_S)
        raise ServerError(f"the server has not loaded the chunk at x={x} z={z}; try again later")

    def _is_loaded(self, x: int, y: int, z: int) -> bool:
        reply = self._send(f"execute if loaded {x} {y} {z}")
        if _SYNTAX_ERROR not in reply:
            return _PASSED in reply
        # Games before 1.19.4 do not know this condition. They test a block, with either result,
        # only if its chunk is loaded.
        reply = self._send(f"execute if block {x} {y} {z} minecraft:air")
        return _PASSED in reply or _FAILED in reply

    def _run(self, command: str) -> None:
        """Send a command that must succeed, and retry it while its chunk is not loaded."""
        for _ in range(LOAD_TRIES):
            reply = self._send(command)
            if _NOT_LOADED not in reply:
                if any(sign in reply for sign in _WRONG):
                    short = command if len(command) < 120 else command[:117] + "..."
                    raise ServerError(
                        f"the server rejected {short!r}: {one_line(reply, 200)}; {_advice(reply)}"
                    )
                return
            self._sleep(LOAD_WAIT_S)
        raise ServerError(f"the server has not loaded the chunk for {command[:80]!r}; try again")

    def _send(self, command: str) -> str:
        """Send a command and return the reply, reconnecting if the connection is lost."""
        wait = FIRST_WAIT_S
        for tries in range(RETRIES + 1):
            try:
                if not self._connected:
                    self._client.connect()
                    self._connected = self._was_there = True
                reply = self._client.command(command)
            except OSError as error:
                self._reconnects += self._connected
                self._connected = False
                if tries == RETRIES or not self._was_there:
                    raise self._connection_error(error) from error
                self._write_note()
                self._sleep(wait)
                wait = min(2 * wait, MAX_WAIT_S)
            else:
                self._commands += 1
                return reply
        raise AssertionError("the last try returns or raises")

    def _connection_error(self, error: OSError) -> ServerError:
        where = f"{self._client.host}:{self._client.port}"
        reason = f"no reply from {where} ({error.strerror or error})"
        if self._was_there:
            return ServerError(f"{reason}; run the same command again to resume the build")
        return ServerError(f"{reason}; set enable-rcon=true in server.properties")

    def _check(self) -> int:
        """Check the probe blocks, and rebuild once if some are wrong."""
        wrong = self._wrong(self._plan.probes)
        if not wrong:
            return 0
        for command in self._plan.work[: self._plan.entities_from]:
            self._run(command)
        left = self._wrong(wrong)
        if left:
            named = "; ".join(f"{x} {y} {z} is not {state}" for x, y, z, state in left[:SHOWN])
            count = f"{len(left)} of {len(self._plan.probes)} checked blocks"
            raise ServerError(
                f"{count} are wrong after the build ({named}); check whether a plugin protects "
                "the area"
            )
        return len(wrong)

    def _wrong(self, probes: Sequence[Probe]) -> list[Probe]:
        found = []
        for done, (x, y, z, state) in enumerate(probes):
            self._progress("check", done, len(probes))
            if _PASSED not in self._send(f"execute if block {x} {y} {z} {state}"):
                found.append((x, y, z, state))
        self._progress("check", len(probes), len(probes))
        return found

    def _read_note(self) -> int:
        """Return the number of commands that an earlier run of this plan has completed."""
        if self._note is None or not self._note.is_file():
            return 0
        try:
            held = read_json(self._note)
            known = {key: held[key] for key in ("server", "plan")}
            done = int(held["done"])
        except (*MALFORMED, InputError):
            return 0
        if known != self._key() or not 0 <= done <= len(self._plan.work):
            return 0
        # Entities would be there twice, so all of them are placed again.
        return min(done, self._plan.entities_from)

    def _set_done(self, done: int) -> None:
        self._done = done
        if time.monotonic() - self._noted_at > NOTE_EVERY_S:
            self._write_note()

    def _write_note(self) -> None:
        self._noted_at = time.monotonic()
        if self._note is not None and self._done:
            write_json(self._note, {**self._key(), "done": self._done})

    def _key(self) -> dict[str, str]:
        return {"server": f"{self._client.host}:{self._client.port}", "plan": self._plan.digest}


def _advice(reply: str) -> str:
    """Return advice for a command that the server rejected."""
    if "Too many blocks" in reply:
        return "set the game rule commandModificationBlockLimit back to 32768"
    if "of this world" in reply or "of the world" in reply:
        return "choose another position (--at), because the build is outside the server's world"
    return "check that the version (--mc-version) is the server's"
