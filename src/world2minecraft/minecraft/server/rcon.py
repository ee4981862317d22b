"""Client for RCON, the remote console protocol of Minecraft servers (Source RCON by Valve).

A packet consists of a little-endian int32 length, an int32 ID, an int32 type (3 for login, 2 for a
command, 0 for a reply), the body in UTF-8 and two zero bytes. The server reads each packet with one
call for at most 1,460 bytes. A command must therefore fit into that size, and only one command may
be in transit: the server closes the connection if a second one arrives in the same segment. Replies
of more than 4,096 bytes arrive in several packets.
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
    """Parse ``HOST:PORT`` and return the host and the port. The default port is 25575.

    Raises:
        UsageError: If the text is not a valid address.
    """
    found = _ADDRESS.fullmatch(text)
    port = int(found["port"] or PORT) if found else 0
    if not found or not 1 <= port <= 65535:
        raise UsageError(f"the server must be HOST:PORT, such as localhost:{PORT}, got {text!r}")
    return found["host"].strip("[]"), port


def build_note_path(server: str, digest: str) -> Path:
    """Return the path of the file that stores the progress of a build on a server."""
    from world2minecraft.core.jit import user_cache_dir  # noqa: PLC0415  # It loads numba.

    name = hashlib.sha256(f"{server} {digest}".encode()).hexdigest()[:24]
    return user_cache_dir() / "rcon" / f"{name}.json"


class RconClient:
    """A connection to the remote console of a server, for use as a context manager.

    Args:
        host: Name or address of the server.
        port: The RCON port, ``rcon.port`` in server.properties. The game's default is 25575.
        password: The RCON password, ``rcon.password`` in server.properties.
        timeout_s: Seconds to wait for the connection and for each reply.
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
            ConnectionError, TimeoutError: If the server cannot be reached or closed the connection.
            ServerError: If the server rejected the password.
        """
        self.close()
        try:
            self._socket = socket.create_connection((self.host, self.port), self.timeout_s)
        except UnicodeError as error:  # A name with an empty part, or one of over 63 letters.
            raise ServerError(
                f"{self.host} is not a valid host name; check the address (--rcon)"
            ) from error
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._send(LOG_IN, self._password.encode("utf-8", "surrogateescape"))
        number, _ = self._receive()
        while number not in (REFUSED, self._number):  # Some servers send an empty reply first.
            number, _ = self._receive()
        if number == REFUSED:
            self.close()
            raise ServerError(
                f"{self.host}:{self.port} rejected the RCON password; set W2M_RCON_PASSWORD to "
                "rcon.password from the server's server.properties"
            )

    def close(self) -> None:
        """Close the connection, if there is one."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def command(self, text: str) -> str:
        """Run one command, without its leading slash, and return the server's reply.

        Raises:
            UsageError: If the command has a line break or more than ``MAX_COMMAND_BYTES`` bytes.
            ConnectionError, TimeoutError: If the connection was lost. The command may have run.
            ServerError: If the server does not use the RCON protocol.
        """
        body = text.encode()
        if len(body) > MAX_COMMAND_BYTES:
            raise UsageError(
                f"an RCON command must be at most {MAX_COMMAND_BYTES} bytes, got {len(body)}: "
                f"{text[:60]}..."
            )
        if any(ord(letter) < 32 for letter in text):
            raise UsageError(f"an RCON command must not contain control characters, got {text!r}")
        self._send(COMMAND, body)
        return self._reply().decode("utf-8", "replace")

    def _reply(self) -> bytes:
        """Return the complete reply to the last command."""
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
            address = f"{self.host}:{self.port}"
            raise ServerError(f"{address} sent an unexpected reply; check that it is an RCON port")
        return b"".join(parts)

    def _send(self, kind: int, body: bytes) -> None:
        self._number = self._number % 0x7FFFFFF + 1
        packet = _HEADER.pack(len(body) + 10, self._number, kind) + body + b"\0\0"
        self._open_socket().sendall(packet)

    def _receive(self) -> tuple[int, bytes]:
        length = struct.unpack("<i", self._exactly(4))[0]
        if not 10 <= length <= MAX_REPLY_BYTES:
            raise ServerError(
                f"{self.host}:{self.port} sent a packet of {length} bytes, which is not RCON; "
                "use the port rcon.port from server.properties"
            )
        data = self._exactly(length)
        number = struct.unpack("<i", data[:4])[0]
        return number, data[8:-2]

    def _exactly(self, count: int) -> bytes:
        held = bytearray()
        while len(held) < count:
            got = self._open_socket().recv(count - len(held))
            if not got:
                raise ConnectionResetError(f"{self.host}:{self.port} closed the connection")
            held += got
        return bytes(held)

    def _open_socket(self) -> socket.socket:
        if self._socket is None:
            raise ConnectionResetError(f"{self.host}:{self.port} is not connected")
        return self._socket
