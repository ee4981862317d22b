"""A player on a game server, which can be placed, moved by keys, and queried for nearby blocks.

The player only advances during calls, while the server continues to run. It uses the network
protocol of an ordinary client, so other players see it walk. A Node.js process runs the player and
replies in JSON lines. The replies are not trusted: their size and duration are limited, and a
process that exceeds the limits or sends invalid data is terminated. Every later request then fails
with the same reason.
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

MAX_LINE = 8 << 20  # Bytes; the blocks of a chunk column take up to 1 MB.
MAX_WAITING = 16  # Unread lines.
MAX_MESSAGE = 500  # Characters of an error message of the player process.
_LAST_WORDS = 2_000  # Bytes of its last output to stderr.
PORT = 25565
DEFAULT_NAME = "w2m_walker"
JOIN_S = 45.0
MOVE_S = 5.0  # Until the server has executed /tp.
STREAM_S = 10.0  # Until a nearby chunk has been received.
SLACK_S = 10.0
MAX_TICKS = 400  # In one request, as in body.mjs.
PLACE_TRIES = 4
SETTLE_TICKS = 80  # A fall of 20 blocks takes 40.
NEAR = 0.05  # Blocks; maximum distance from the target of /tp.
_KEYS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
_ADDRESS = re.compile(r"(?P<host>\[[0-9A-Fa-f:.%]+\]|[A-Za-z0-9.-]+)(?::(?P<port>[0-9]{1,5}))?")
_PLAYER = re.compile(r"[A-Za-z0-9_]{3,16}")
_VERSION = re.compile(r"1\.[0-9]{1,2}(\.[0-9]{1,2})?")


class JsonLineProcess:
    """A child process that answers requests in JSON lines.

    Args:
        command: The command to run.
        folder: The working directory.
        environment: The environment variables. None inherits those of this process.

    Raises:
        ServerError: If the process cannot be started.
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
        """Send a request, and return the reply.

        Args:
            act: The name of the request.
            timeout_s: Seconds to wait for the reply.
            values: The arguments of the request.

        Raises:
            ServerError: If the request is refused, times out or gets an invalid reply.
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
            self._give_up("the player process has exited")
        answer = self._answer(act, timeout_s)
        if "error" in answer:
            raise ServerError(f"{act}: {_plain(answer['error'])}")
        return answer

    def close(self) -> None:
        """Terminate the process."""
        self._broken = self._broken or "the player has left the server"
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
                self._give_up(f"{act}: no reply within {timeout_s:g} s")
            if line is None:
                self._give_up("the player process has exited")
            answer = self._read(line)
            if answer.get("id") == self._asked:
                return answer

    def _read(self, line: bytes) -> dict[str, Any]:
        if len(line) >= MAX_LINE:
            self._give_up(f"a reply of the player process exceeds {MAX_LINE:,} bytes")
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            self._give_up("a reply of the player process is not a JSON object")
        return answer

    def _give_up(self, reason: str) -> NoReturn:
        """Terminate the process, and raise ServerError with its last error output."""
        if self._process.poll() is None:
            self._process.kill()
        self._overhearing.join(1.0)
        words = _plain(self._last_words.decode("utf-8", "replace").strip())
        self._broken = f"{reason}; last error output: {words}" if words else reason
        raise ServerError(self._broken)

    def _hear(self, stream: IO[bytes]) -> None:
        try:
            while line := stream.readline(MAX_LINE):
                self._lines.put(line, timeout=60)
        except (OSError, ValueError, queue.Full):
            pass  # The stream was closed, or the process sends unrequested lines.
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
    """Return an untrusted text on one line, with printable characters only and truncated."""
    kept = "".join(c if c.isprintable() else " " for c in str(text)[-MAX_MESSAGE:])
    return " ".join(kept.split())


class Change(NamedTuple):
    """A changed block, with its position and its new state."""

    place: tuple[int, int, int]
    state: str


class ServerPlayer:
    """A player that has joined a server. Create it with ``join``, and use it as a context manager.

    Attributes:
        address: The address of the server.
        version: The game version of the server.
        name: The player name.
        body: The position and movement of the player.
        changes: The blocks that have changed since the last ``take_changes``.
        has_many_changes: Whether there were too many changes to list.
        corrections: How often the server has moved the player while keys were held, since
            ``place``.
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
        """Hold keys, one entry per tick, and return the body after each tick.

        Raises:
            ServerError: If the player is disconnected, or the ground under it has not been
                received.
        """
        poses: list[Body] = []
        for start in range(0, len(keys), MAX_TICKS):
            part = keys[start : start + MAX_TICKS]
            ticks = [[_key_mask(one), one.yaw_deg, pitch_deg] for one in part]
            limit_s = SLACK_S + 5 * len(part) / TICKS_PER_S
            answer = self._bridge.ask("hold", limit_s, ticks=ticks)
            found = answer.get("poses")
            if not isinstance(found, list) or len(found) != len(part):
                raise ServerError("the player process reported an unexpected number of ticks")
            self._take(answer)
            self.corrections += int(answer.get("forced", 0))
            poses += [_body(pose, one) for pose, one in zip(found, part, strict=True)]
        self.body = poses[-1] if poses else self.body
        return poses

    def place(self, feet: tuple[float, float, float], yaw_deg: float = 0.0) -> Body:
        """Move the player with the command /tp, and wait until it is at rest.

        Raises:
            ServerError: If the server does not move the player, for example because it is no
                operator.
        """
        for _ in range(PLACE_TRIES):
            self._put(feet)
            self.corrections = 0
            self.settle(yaw_deg)
            if not self.corrections and _horizontal_distance(self.body.position, feet) <= NEAR:
                return self.body  # A busy server may move the player to its spawn after joining.
        x, _, z = self.body.position
        raise ServerError(
            f"the server moved the player away from the requested position, to {x:.1f} {z:.1f}"
        )

    def _put(self, feet: tuple[float, float, float]) -> None:
        """Send /tp, and wait until the player has moved."""
        x, y, z = feet
        answer = self._bridge.ask("place", MOVE_S + SLACK_S, x=x, y=y, z=z, wait_ms=MOVE_S * 1e3)
        self._take(answer)
        self.body = _body(answer.get("pose"), Keys())
        if not answer.get("moved") or math.dist(self.body.position, feet) > NEAR:
            raise ServerError(
                f"the server did not move the player to {x:.1f} {y:.1f} {z:.1f}; run 'op "
                f"{self.name}' on the server console"
            )

    def settle(self, yaw_deg: float = 0.0) -> Body:
        """Release all keys until the player is at rest, and return its body."""
        for _ in range(0, SETTLE_TICKS, 4):
            self.hold([Keys(yaw_deg=yaw_deg)] * 4)
            vx, _, vz = self.body.velocity
            if self.body.on_ground and vx == vz == 0.0:
                break
        return self.body

    def read(self, box: Sequence[int]) -> BlockVolume:
        """Return the blocks of a box x0 y0 z0 x1 y1 z1 with exclusive ends.

        Raises:
            UsageError: If the box is invalid.
            ServerError: If a part of the box has not been received.
        """

        def ask(act: str, **values: Any) -> dict[str, Any]:
            return self._bridge.ask(act, STREAM_S + SLACK_S, wait_ms=STREAM_S * 1e3, **values)

        return read_blocks(ask, checked_box(box), self.version)

    def take_changes(self) -> list[Change]:
        """Return the changed blocks in the order of their first change, and clear the list."""
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
            raise ServerError("the player process sent changed blocks that are not a list")
        data_version = data_version_of(self.version)
        for row in found:
            if not isinstance(row, list) or len(row) != 4:
                raise ServerError(
                    "the player process sent a changed block without a valid position and state"
                )
            x, y, z = (_number(value) for value in row[:3])
            self.changes.append(Change((int(x), int(y), int(z)), state_of(row[3], data_version)))
        self.has_many_changes |= bool(answer.get("too_many"))


def join(
    address: str, *, name: str = DEFAULT_NAME, version: str = "", folder: Path | None = None
) -> ServerPlayer:
    """Join a server that admits players without an account (``online-mode=false``).

    Args:
        address: HOST or HOST:PORT. The default port is 25565.
        name: The player name.
        version: The game version, such as 1.20.1. If empty, the server is queried.
        folder: A folder whose ``node_modules`` contains mineflayer. None uses the folder of
            ``mineflayer_install.install``.

    Raises:
        UsageError: If the address or a name is invalid, or mineflayer is not installed.
        ServerError: If the server does not respond, or does not admit the player.
    """
    found = _ADDRESS.fullmatch(address)
    port = int(found["port"] or PORT) if found else 0
    if not found or not 1 <= port <= 65535:
        raise UsageError(
            f"the server address must be HOST:PORT, such as localhost:{PORT}, got {address!r}"
        )
    if not _PLAYER.fullmatch(name):
        raise UsageError(
            f"a player name must be 3 to 16 letters, digits or underscores, got {name!r}"
        )
    if version and not _VERSION.fullmatch(version):
        raise UsageError(f"the version must have the form 1.20.1, got {version!r}")
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
    """Return the horizontal distance between two positions in blocks."""
    return math.hypot(one[0] - other[0], one[2] - other[2])


def _key_mask(keys: Keys) -> int:
    return sum(int(getattr(keys, key)) << bit for bit, key in enumerate(_KEYS))


def _body(pose: Any, keys: Keys) -> Body:
    """Return the body described by a list of eight numbers."""
    if not isinstance(pose, list) or len(pose) != 8:
        raise ServerError("the player process did not send its position")
    x, y, z, vx, vy, vz, on_ground, hit_wall = (_number(value) for value in pose)
    return Body(
        (x, y, z), (vx, vy, vz), on_ground=bool(on_ground), crouched=keys.sneak,
        hit_wall=bool(hit_wall),
    )  # fmt: skip


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e8:
        raise ServerError("the player process sent a position that is not a number")
    return float(value)
