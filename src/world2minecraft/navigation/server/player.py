"""A player on a server: it stands where it is put, holds keys for ticks and reports what is around.

Its time stands still between two calls; the server's goes on. Where it is, the server knows by the
packets of any player's client, so that all who play there see it walk. Node runs the player; it
answers lines of JSON, none of them trusted: replies are bounded in size and time, and a process
that sends too much, too late or nothing that can be read is ended, and every later request is
refused with the reason.
"""

import json
import math
import queue
import re
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any, NamedTuple, NoReturn

from world2minecraft.core.errors import ServerError, UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics import TICKS_PER_S, Body, Keys
from world2minecraft.navigation.server.mineflayer_install import body_folder, node, script
from world2minecraft.navigation.server.streamed_blocks import (
    checked_box,
    data_version_of,
    read_blocks,
    state_of,
)

MAX_LINE = 8 << 20  # Bytes: the blocks of a chunk column take up to 1 MB.
MAX_WAITING = 16  # Lines that nobody asked for.
MAX_MESSAGE = 500  # Characters of an error of the other side.
_LAST_WORDS = 2_000  # Bytes of what it wrote to stderr.
PORT = 25565
DEFAULT_NAME = "w2m_walker"
JOIN_S = 45.0
MOVE_S = 5.0  # Until a server has done what /tp says.
STREAM_S = 10.0  # Until a chunk that is near has come.
SLACK_S = 10.0
MAX_TICKS = 400  # In one question, as body.mjs has it.
PLACE_TRIES = 4
SETTLE_TICKS = 80  # A fall of 20 blocks takes 40.
NEAR = 0.05  # Blocks: where /tp leads to.
_KEYS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
_ADDRESS = re.compile(r"(?P<host>\[[0-9A-Fa-f:.%]+\]|[A-Za-z0-9.-]+)(?::(?P<port>[0-9]{1,5}))?")
_PLAYER = re.compile(r"[A-Za-z0-9_]{3,16}")
_VERSION = re.compile(r"1\.[0-9]{1,2}(\.[0-9]{1,2})?")


class JsonLineProcess:
    """A process that answers questions.

    Args:
        command: what to run.
        folder: where.
        environment: its environment; None for ours.

    Raises:
        ServerError: it cannot be started.
    """

    def __init__(
        self, command: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None
    ):
        try:
            self._process = subprocess.Popen(
                list(command), cwd=folder, env=dict(environment) if environment else None,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            )  # fmt: skip
        except OSError as error:
            raise ServerError(f"cannot run {command[0]}: {error.strerror}") from error
        self._lines: queue.Queue[bytes | None] = queue.Queue(MAX_WAITING)
        self._last_words, self._asked, self._broken = b"", 0, ""
        out, err = self._process.stdout, self._process.stderr
        threading.Thread(target=self._hear, args=(out,), daemon=True).start()
        self._overhearing = threading.Thread(target=self._overhear, args=(err,), daemon=True)
        self._overhearing.start()

    def ask(self, act: str, timeout_s: float, **values: Any) -> dict[str, Any]:
        """Return the answer to an act.

        Raises:
            ServerError: the other side refuses, is silent for too long, or cannot be understood.
        """
        if self._broken:
            raise ServerError(self._broken)
        self._asked += 1
        line = json.dumps({"id": self._asked, "do": act, **values}, allow_nan=False)
        stdin = self._process.stdin
        try:
            if stdin:
                stdin.write(line.encode() + b"\n")
                stdin.flush()
        except OSError:
            self._give_up("the body on the server has ended")
        answer = self._answer(act, timeout_s)
        if "error" in answer:
            raise ServerError(f"{act}: {_plain(answer['error'])}")
        return answer

    def close(self) -> None:
        """End the process."""
        self._broken = self._broken or "the body has left the server"
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream:
                try:
                    stream.close()
                except OSError:
                    continue

    def _answer(self, act: str, timeout_s: float) -> dict[str, Any]:
        end_s = time.monotonic() + timeout_s
        while True:
            try:
                line = self._lines.get(timeout=max(end_s - time.monotonic(), 0.0))
            except queue.Empty:
                self._give_up(f"{act}: no answer in {timeout_s:g} s")
            if line is None:
                self._give_up("the body on the server has ended")
            answer = self._read(line)
            if answer.get("id") == self._asked:
                return answer

    def _read(self, line: bytes) -> dict[str, Any]:
        if len(line) >= MAX_LINE:
            self._give_up(f"an answer is longer than {MAX_LINE:,} bytes")
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            self._give_up("an answer is no JSON object")
        return answer

    def _give_up(self, reason: str) -> NoReturn:
        """End the process and raise why, with the last that it wrote."""
        if self._process.poll() is None:
            self._process.kill()
        self._overhearing.join(1.0)
        words = _plain(self._last_words.decode("utf-8", "replace").strip())
        self._broken = f"{reason}; its last words: {words}" if words else reason
        raise ServerError(self._broken)

    def _hear(self, stream: IO[bytes]) -> None:
        try:
            while line := stream.readline(MAX_LINE):
                self._lines.put(line, timeout=60)
        except (OSError, ValueError, queue.Full):
            pass  # It was closed, or says what nobody asked for.
        try:
            self._lines.put(None, timeout=60)
        except queue.Full:
            return

    def _overhear(self, stream: IO[bytes]) -> None:
        try:
            while part := stream.read1(_LAST_WORDS):  # type: ignore[attr-defined]
                self._last_words = (self._last_words + part)[-_LAST_WORDS:]
        except (OSError, ValueError):
            return


def _plain(text: Any) -> str:
    """Return a text of others on one line, of printable characters, not too long."""
    kept = "".join(c if c.isprintable() else " " for c in str(text)[-MAX_MESSAGE:])
    return " ".join(kept.split())


class Change(NamedTuple):
    """A block that became another."""

    place: tuple[int, int, int]
    state: str


class ServerPlayer:
    """A player that has joined. Use it in a ``with``; ``join`` makes one.

    ``changes`` are the blocks that changed since they were last taken; ``has_many_changes`` says
    that there were too many to list. ``corrections`` counts how often the server put the player
    somewhere while keys were held, since ``place``.
    """

    def __init__(self, bridge: JsonLineProcess, address: str, state: dict[str, Any]):
        self._bridge = bridge
        self.address, self.version = address, str(state.get("version", ""))[:20]
        self.name = str(state.get("name", DEFAULT_NAME))[:16]
        self.changes: list[Change] = []
        self.has_many_changes, self.corrections = False, 0
        self._take(state)
        self.body = _body(state.get("pose"), Keys())

    def __enter__(self) -> "ServerPlayer":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def hold(self, keys: Sequence[Keys], pitch_deg: float = 0.0) -> list[Body]:
        """Hold keys, a tick each, and return the body after each tick.

        Raises:
            ServerError: the player is gone, or the ground under it has not been streamed.
        """
        poses: list[Body] = []
        for start in range(0, len(keys), MAX_TICKS):
            part = keys[start : start + MAX_TICKS]
            ticks = [[_key_mask(one), one.yaw_deg, pitch_deg] for one in part]
            limit_s = SLACK_S + 5 * len(part) / TICKS_PER_S
            answer = self._bridge.ask("hold", limit_s, ticks=ticks)
            found = answer.get("poses")
            if not isinstance(found, list) or len(found) != len(part):
                raise ServerError("the body tells of other ticks than it was asked for")
            self._take(answer)
            self.corrections += int(answer.get("forced", 0))
            poses += [_body(pose, one) for pose, one in zip(found, part, strict=True)]
        self.body = poses[-1] if poses else self.body
        return poses

    def place(self, feet: tuple[float, float, float], yaw_deg: float = 0.0) -> Body:
        """Put the player somewhere by the command /tp, and let it come to rest there.

        Raises:
            ServerError: the server does not do so; players need to be operators for /tp.
        """
        for _ in range(PLACE_TRIES):
            self._put(feet)
            self.corrections = 0
            self.settle(yaw_deg)
            if not self.corrections and _horizontal_distance(self.body.position, feet) <= NEAR:
                return self.body  # A busy server may still move one to its spawn after joining.
        x, _, z = self.body.position
        raise ServerError(
            f"the server moves the player away from where it is put, to {x:.1f} {z:.1f}"
        )

    def _put(self, feet: tuple[float, float, float]) -> None:
        """Say /tp, and wait until the player is there."""
        x, y, z = feet
        answer = self._bridge.ask("place", MOVE_S + SLACK_S, x=x, y=y, z=z, wait_ms=MOVE_S * 1e3)
        self._take(answer)
        self.body = _body(answer.get("pose"), Keys())
        if not answer.get("moved") or math.dist(self.body.position, feet) > NEAR:
            raise ServerError(
                f"the server did not put the player at {x:.1f} {y:.1f} {z:.1f}; "
                f"on its console say: op {self.name}"
            )

    def settle(self, yaw_deg: float = 0.0) -> Body:
        """Hold no key until the player stands at rest, and return it."""
        for _ in range(0, SETTLE_TICKS, 4):
            self.hold([Keys(yaw_deg=yaw_deg)] * 4)
            vx, _, vz = self.body.velocity
            if self.body.on_ground and vx == vz == 0.0:
                break
        return self.body

    def read(self, box: Sequence[int]) -> BlockVolume:
        """Return the blocks of a box, x0 y0 z0 x1 y1 z1, its last corner not included.

        Raises:
            UsageError: it is no box. ServerError: a part of it has not been streamed.
        """

        def ask(act: str, **values: Any) -> dict[str, Any]:
            return self._bridge.ask(act, STREAM_S + SLACK_S, wait_ms=STREAM_S * 1e3, **values)

        return read_blocks(ask, checked_box(box), self.version)

    def take_changes(self) -> list[Change]:
        """Return the changed blocks in the order in which they changed first, and forget them."""
        taken, self.changes, self.has_many_changes = self.changes, [], False
        return taken

    def close(self) -> None:
        """Leave the server."""
        try:
            self._bridge.ask("leave", SLACK_S)
        except ServerError:
            pass
        finally:
            self._bridge.close()

    def _take(self, answer: dict[str, Any]) -> None:
        found = answer.get("changed", [])
        if not isinstance(found, list):
            raise ServerError("the body tells of changed blocks that are no list")
        data_version = data_version_of(self.version)
        for row in found:
            if not isinstance(row, list) or len(row) != 4:
                raise ServerError("a changed block is no place and state")
            x, y, z = (_number(value) for value in row[:3])
            self.changes.append(Change((int(x), int(y), int(z)), state_of(row[3], data_version)))
        self.has_many_changes |= bool(answer.get("too_many"))


def join(
    address: str, *, name: str = DEFAULT_NAME, version: str = "", folder: Path | None = None
) -> ServerPlayer:
    """Join a server that lets players in without an account (``online-mode=false``).

    Args:
        address: HOST or HOST:PORT; the port is 25565 where it is left out.
        name: of the player.
        version: of the game, such as 1.20.1; the server is asked where it is left out.
        folder: whose ``node_modules`` hold mineflayer; what ``installing.install`` made if None.

    Raises:
        UsageError: the address or a name cannot be, or mineflayer is not installed.
        ServerError: nobody answers there, or it lets the player not in.
    """
    found = _ADDRESS.fullmatch(address)
    port = int(found["port"] or PORT) if found else 0
    if not found or not 1 <= port <= 65535:
        raise UsageError(f"a server is HOST:PORT, such as localhost:{PORT}, not {address!r}")
    if not _PLAYER.fullmatch(name):
        raise UsageError(f"a player's name is 3 to 16 letters, digits and _, not {name!r}")
    if version and not _VERSION.fullmatch(version):
        raise UsageError(f"a version is like 1.20.1, not {version!r}")
    place = folder or body_folder()
    bridge = JsonLineProcess([node(), str(script()), str(place)], place)
    try:
        state = bridge.ask(
            "join", JOIN_S + SLACK_S, host=found["host"].strip("[]"), port=port, name=name,
            version=version, wait_ms=JOIN_S * 1e3,
        )  # fmt: skip
        return ServerPlayer(bridge, address, state)
    except BaseException:
        bridge.close()
        raise


def _horizontal_distance(
    one: tuple[float, float, float], other: tuple[float, float, float]
) -> float:
    """Return how far places are from each other along the ground, blocks."""
    return math.hypot(one[0] - other[0], one[2] - other[2])


def _key_mask(keys: Keys) -> int:
    return sum(int(getattr(keys, key)) << bit for bit, key in enumerate(_KEYS))


def _body(pose: Any, keys: Keys) -> Body:
    """Return the body that eight numbers tell of."""
    if not isinstance(pose, list) or len(pose) != 8:
        raise ServerError("the body does not tell where it is")
    x, y, z, vx, vy, vz, on_ground, hit_wall = (_number(value) for value in pose)
    return Body(
        (x, y, z), (vx, vy, vz), on_ground=bool(on_ground), crouched=keys.sneak,
        hit_wall=bool(hit_wall),
    )  # fmt: skip


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e8:
        raise ServerError("the body tells of a place that is no number")
    return float(value)
