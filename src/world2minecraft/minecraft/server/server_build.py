"""Build a volume on a running server, across lost connections, and check the result.

A plan lists the commands in order. Progress is noted in a small file, so that a second run resumes
where the first was stopped.
"""

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import InputError, ServerError, UsageError, one_line
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
    state_in_version,
)
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.server.rcon import MAX_COMMAND_BYTES, RconClient
from world2minecraft.minecraft.versions import GameVersion

PROBE_STEP = 64  # Blocks between the places at which it is asked whether chunks are loaded.
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


Probe = tuple[int, int, int, str]  # x, y, z and what must be there of a state


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
        losses: counts data and entities that are too long for a command.

    Raises:
        UsageError: a state or an entity's id is none, or the box leaves the world's layers.
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


def _drop_long_commands(what: str, commands: Sequence[str], losses: Losses) -> list[str]:
    short = [command for command in commands if len(command.encode()) <= MAX_COMMAND_BYTES]
    losses.add(what, len(commands) - len(short))
    return short


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
    """Result of a build: commands sent, reconnections, places checked, blocks set again."""

    commands: int
    reconnects: int
    checked: int
    repaired: int


class LiveBuilder:
    """Runs a plan on one server.

    Args:
        client: where to; it is connected when it is used.
        plan: the commands.
        note: the file that remembers how far it is; None remembers nothing.
        progress: called with the commands done.
        sleep: how to wait; tests do not.
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
        """Build, check, and repair what is wrong.

        Raises:
            ServerError: the server cannot be reached, refuses, does not load the chunks, or does
                not hold the blocks in the end. What was done is noted; a second run goes on.
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
        """Have the chunks loaded, and wait until they are; those that were stay so in the end."""
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
        raise ServerError(f"the server has not loaded the chunk at {x} {z}; try again later")

    def _is_loaded(self, x: int, y: int, z: int) -> bool:
        reply = self._send(f"execute if loaded {x} {y} {z}")
        if _SYNTAX_ERROR not in reply:
            return _PASSED in reply
        # Games before 1.19.4 do not know the question. Of a block they tell, whichever it is,
        # where its chunk is loaded.
        reply = self._send(f"execute if block {x} {y} {z} minecraft:air")
        return _PASSED in reply or _FAILED in reply

    def _run(self, command: str) -> None:
        """Send a command that must work, again while its chunk is not loaded."""
        for _ in range(LOAD_TRIES):
            reply = self._send(command)
            if _NOT_LOADED not in reply:
                if any(sign in reply for sign in _WRONG):
                    short = command if len(command) < 120 else command[:117] + "..."
                    raise ServerError(
                        f"the server refused {short!r}: {one_line(reply, 200)}; {_advice(reply)}"
                    )
                return
            self._sleep(LOAD_WAIT_S)
        raise ServerError(f"the server has not loaded the place of {command[:80]!r}")

    def _send(self, command: str) -> str:
        """Send a command and return the reply; reconnect where the connection is lost."""
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
        reason = f"{where} does not answer ({error.strerror or error})"
        if self._was_there:
            return ServerError(f"{reason} any more; run the same command again to go on")
        return ServerError(f"{reason}; it needs enable-rcon=true in server.properties")

    def _check(self) -> int:
        """Ask for the probes; where one is wrong, build once more and ask for it again."""
        wrong = self._wrong(self._plan.probes)
        if not wrong:
            return 0
        for command in self._plan.work[: self._plan.entities_from]:
            self._run(command)
        left = self._wrong(wrong)
        if left:
            named = "; ".join(f"{x} {y} {z} is not {state}" for x, y, z, state in left[:SHOWN])
            count = f"{len(left)} of {len(self._plan.probes)} blocks"
            raise ServerError(
                f"{count} are not as they were set: {named}. A plugin "
                "that protects the place may forbid it"
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
        """Return how many commands a former run of this plan on this server has done."""
        if self._note is None or not self._note.is_file():
            return 0
        try:
            held = read_json(self._note)
            known = {key: held[key] for key in ("server", "plan")}
            done = int(held["done"])
        except (InputError, KeyError, TypeError, ValueError):
            return 0
        if known != self._key() or not 0 <= done <= len(self._plan.work):
            return 0
        # Entities would stand there twice: they are set from their first one on.
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
    """What to do about a command that was refused."""
    if "Too many blocks" in reply:
        return "set the game rule commandModificationBlockLimit back to 32768"
    if "of this world" in reply or "of the world" in reply:
        return "choose another --at: the build reaches out of the server's world"
    return "is --mc-version its version?"
