"""RCON, the remote console of Minecraft servers (Valve's Source RCON protocol).

A packet is a little-endian int32 length, int32 id, int32 type (3 log in, 2 command, 0 reply), the
body in UTF-8 and two zero bytes. The game's server reads each packet with one call that takes
1,460 bytes, so a command must fit into that, and only one may be on its way: a second that comes
in the same segment makes it hang up. Replies over 4,096 bytes come in several packets.
"""

import hashlib
import re
import socket
import struct
from pathlib import Path
from types import TracebackType

from world2minecraft.core.errors import ServerError, UsageError

PORT = 25575
_ADDRESS = re.compile(r"(?P<host>\[[0-9A-Fa-f:.%]+\]|[A-Za-z0-9.-]+)(?::(?P<port>[0-9]{1,5}))?")
MAX_COMMAND_BYTES = 1446  # 1,460 of the server's buffer, less the header and the zeros.
MAX_REPLY_BYTES = 1 << 20  # What a server may send as one packet before it is taken for a mistake.
FULL_REPLY_BYTES = 4096  # A reply this long goes on in the next packet.
LOG_IN, COMMAND = 3, 2
REFUSED = -1
_HEADER = struct.Struct("<iii")


def parse_address(text: str) -> tuple[str, int]:
    """Return host and port of ``HOST:PORT``; the port is 25575 where it is left out.

    Raises:
        UsageError: it is no address.
    """
    found = _ADDRESS.fullmatch(text)
    port = int(found["port"] or PORT) if found else 0
    if not found or not 1 <= port <= 65535:
        raise UsageError(f"--rcon must be HOST:PORT, such as localhost:{PORT}, not {text!r}")
    return found["host"].strip("[]"), port


def build_note_path(server: str, digest: str) -> Path:
    """Return the file that remembers how far a build on a server is."""
    from world2minecraft.core.jit import user_cache_dir  # noqa: PLC0415  # It loads numba.

    name = hashlib.sha256(f"{server} {digest}".encode()).hexdigest()[:24]
    return user_cache_dir() / "rcon" / f"{name}.json"


class RconClient:
    """One connection to a server's remote console. Use it in a ``with``.

    Args:
        host: its name or address.
        port: 25575, unless ``rcon.port`` in server.properties says otherwise.
        password: ``rcon.password`` of server.properties.
        timeout_s: how long to wait for the connection and for each reply.
    """

    def __init__(self, host: str, port: int, password: str, timeout_s: float = 20.0):
        self.host, self.port, self.timeout_s = host, port, timeout_s
        self._password = password
        self._socket: socket.socket | None = None
        self._number = 0

    def __enter__(self) -> "RconClient":
        self.connect()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def connect(self) -> None:
        """Connect and log in.

        Raises:
            ConnectionError, TimeoutError: the server is not there or hung up.
            ServerError: it refused the password.
        """
        self.close()
        try:
            self._socket = socket.create_connection((self.host, self.port), self.timeout_s)
        except UnicodeError as error:  # A name with an empty part, or one of over 63 letters.
            raise ServerError(f"{self.host} is no name of a server; check --rcon") from error
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._send(LOG_IN, self._password.encode("utf-8", "surrogateescape"))
        number, _ = self._receive()
        while number not in (REFUSED, self._number):  # Some servers send an empty reply first.
            number, _ = self._receive()
        if number == REFUSED:
            self.close()
            raise ServerError(
                f"{self.host}:{self.port} refused the password; set W2M_RCON_PASSWORD to "
                "rcon.password of its server.properties"
            )

    def close(self) -> None:
        """Hang up; nothing happens where there is no connection."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def command(self, text: str) -> str:
        """Run one command, without its slash, and return what the server says.

        Raises:
            UsageError: the command has a line break or more than ``MAX_COMMAND_BYTES`` bytes.
            ConnectionError, TimeoutError: the connection was lost; the command may have run.
            ServerError: the server speaks no RCON.
        """
        body = text.encode()
        if len(body) > MAX_COMMAND_BYTES:
            raise UsageError(
                f"a command may have {MAX_COMMAND_BYTES} bytes by RCON, not {len(body)}: "
                f"{text[:60]}..."
            )
        if any(ord(letter) < 32 for letter in text):
            raise UsageError(f"a command is one line without control characters, not {text!r}")
        self._send(COMMAND, body)
        return self._reply().decode("utf-8", "replace")

    def _reply(self) -> bytes:
        """Return the whole reply to the command that was sent last."""
        wanted = self._number
        number, body = self._receive()
        parts = [body]
        if number == wanted and len(body) >= FULL_REPLY_BYTES:
            # More may follow. The answer to an empty command shows where the reply ends.
            self._send(COMMAND, b"")
            number, body = self._receive()
            while number == wanted:
                parts.append(body)
                number, body = self._receive()
        elif number != wanted:
            raise ServerError(f"{self.host}:{self.port} answered out of turn; is it RCON?")
        return b"".join(parts)

    def _send(self, kind: int, body: bytes) -> None:
        self._number = self._number % 0x7FFFFFF + 1
        packet = _HEADER.pack(len(body) + 10, self._number, kind) + body + b"\0\0"
        self._open_socket().sendall(packet)

    def _receive(self) -> tuple[int, bytes]:
        length = struct.unpack("<i", self._exactly(4))[0]
        if not 10 <= length <= MAX_REPLY_BYTES:
            raise ServerError(
                f"{self.host}:{self.port} sent a packet of {length} bytes; is it RCON? "
                "server.properties names the port: rcon.port"
            )
        data = self._exactly(length)
        number = struct.unpack("<i", data[:4])[0]
        return number, data[8:-2]

    def _exactly(self, count: int) -> bytes:
        held = bytearray()
        while len(held) < count:
            got = self._open_socket().recv(count - len(held))
            if not got:
                raise ConnectionResetError(f"{self.host}:{self.port} hung up")
            held += got
        return bytes(held)

    def _open_socket(self) -> socket.socket:
        if self._socket is None:
            raise ConnectionResetError(f"{self.host}:{self.port} is not connected")
        return self._socket
