"""The server process: a socket, an access token, a link, and uvicorn until it is stopped."""

import asyncio
import os
import socket
import ssl
import threading
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Self

import uvicorn
from starlette.types import ASGIApp

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.sceneforge.agent_walks import WalkAgents
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.phone_access import PhoneAccess
from world2minecraft.sceneforge.server.app import build_app
from world2minecraft.sceneforge.server.guard import new_token
from world2minecraft.sceneforge.server.limits import MAX_JSON_BYTES
from world2minecraft.sceneforge.server.local_address import is_loopback
from world2minecraft.sceneforge.server.phone_routes import phone_app
from world2minecraft.sceneforge.session import Session
from world2minecraft.sceneforge.uploads import MAX_UPLOAD_BYTES, user_home
from world2minecraft.sceneforge.workspace import Workspace

LOOPBACK = "127.0.0.1"
PORT = 8484  # The same each time, so that the page's own settings are found again.
PHONE_PORT = 8485
EVERY_ADDRESS = ("0.0.0.0", "::")
MAX_PHONE_CONNECTIONS = 64  # A browser opens six.
STOPPING_S = 3


class PageServer:
    """A web server for one user: ``run`` serves in this thread, ``start`` in a background thread.

    Args:
        build: Function that creates the application from a token and a port.
        host: Address to listen on. Use an address other than loopback to allow remote connections.
        port: Port to listen on. None uses 8484, or any free port if 8484 is taken.
        token: Access token in the link. None creates a new one.
        usual_port: Port that None tries first, in place of 8484.
        tls: Files of a certificate chain and its private key (PEM). None serves plain HTTP.
        max_connections: Maximum number of connections at a time. None sets no limit.

    Raises:
        UsageError: If the port is taken, or if this machine does not have the address.
        InputError: If the certificate or its key cannot be used.
    """

    def __init__(
        self,
        build: Callable[[str, int], ASGIApp],
        *,
        host: str = LOOPBACK,
        port: int | None = None,
        token: str | None = None,
        usual_port: int = PORT,
        tls: tuple[Path, Path] | None = None,
        max_connections: int | None = None,
    ):
        if tls is not None:
            _check_certificate(*tls)
        self.scheme = "http" if tls is None else "https"
        self.socket = _listening(host, port, usual_port)
        self.host, self.port = host, int(self.socket.getsockname()[1])
        self.token = token or new_token()
        self.is_open = not is_loopback(host)
        config = uvicorn.Config(
            build(self.token, self.port),
            access_log=False,  # It would print the token.
            log_level="error",
            lifespan="off",
            server_header=False,
            ws_max_size=MAX_JSON_BYTES,
            ws_per_message_deflate=False,  # No message can grow when it is unpacked.
            timeout_graceful_shutdown=STOPPING_S,
            limit_concurrency=max_connections,
            ssl_certfile=None if tls is None else tls[0],
            ssl_keyfile=None if tls is None else tls[1],
        )
        self._server = uvicorn.Server(config)
        self._thread: threading.Thread | None = None

    @property
    def url(self) -> str:
        """The URL of the page, without the token."""
        return page_url(self.scheme, self.host, self.port)

    @property
    def link(self) -> str:
        """The URL that the user opens, including the token."""
        return f"{self.url}?token={self.token}"

    def run(self, ready: Callable[[], None] = lambda: None) -> None:
        """Serve until interrupted, and call ``ready`` as soon as pages can be opened."""
        with suppress(KeyboardInterrupt):  # uvicorn raises it again after it has stopped.
            asyncio.run(self._serve(ready))

    def start(self) -> Self:
        """Start serving in a background thread, and return when pages can be opened."""
        begun = threading.Event()
        self._thread = threading.Thread(target=self.run, args=(begun.set,), daemon=True)
        self._thread.start()
        while not begun.wait(0.05):
            if not self._thread.is_alive():
                raise UsageError("the server did not start; see its log in the terminal")
        return self

    def stop(self) -> None:
        """Stop the server, release its resources and return when this is done."""
        self._server.should_exit = True
        if self._thread is not None:
            self._thread.join()

    def __enter__(self) -> Self:
        """Start the server and return it."""
        return self.start()

    def __exit__(self, *_: object) -> None:
        """Stop the server."""
        self.stop()

    async def _serve(self, ready: Callable[[], None]) -> None:
        serving = asyncio.create_task(self._server.serve(sockets=[self.socket]))
        try:
            while not self._server.started and not serving.done():
                await asyncio.sleep(0.005)
            ready()
            await serving
        finally:
            self.socket.close()
            await self.close()

    async def close(self) -> None:
        """Release the resources of the application after the last request."""


class _SignallessServer(uvicorn.Server):
    """A server that leaves Ctrl+C to the server beside it."""

    @contextmanager
    def capture_signals(self) -> Generator[None, None, None]:
        yield


class PhoneServer(PageServer):
    """The web server of the phone page, which runs beside the server of a workspace.

    ``access`` holds its codes and sessions.

    Args:
        workspace: The workspace that takes the captures.
        host: Address of this machine on the local network.
        tls: Certificate and key, as for ``PageServer``.

    Raises:
        UsageError: If this machine does not have the address.
        InputError: If the certificate or its key cannot be used.
    """

    def __init__(self, workspace: Workspace, host: str, tls: tuple[Path, Path] | None = None):
        if host in EVERY_ADDRESS:
            raise UsageError(
                f"--phone serves one address, not {host}; name the one that phones see, "
                "such as --host 192.168.1.5"
            )

        made: list[PhoneAccess] = []

        def build(token: str, port: int) -> ASGIApp:
            """Return the app of the editor for a token and a port."""
            made.append(PhoneAccess(page_url("http" if tls is None else "https", host, port)))
            return phone_app(made[0], workspace)

        super().__init__(
            build,
            host=host,
            usual_port=PHONE_PORT,
            tls=tls,
            max_connections=MAX_PHONE_CONNECTIONS,
        )
        self._server = _SignallessServer(self._server.config)
        (self.access,) = made
        workspace.phone = self.access

    async def serve(self) -> None:
        """Serve in the running event loop until ``end`` is called."""
        try:
            await self._server.serve(sockets=[self.socket])
        finally:
            self.socket.close()

    def end(self) -> None:
        """Let ``serve`` return."""
        self._server.should_exit = True


class ForgeServer(PageServer):
    """A web server that edits one document.

    Args:
        editor: The editor of the document. None shows the start page.
        host: Address to listen on, as for ``PageServer``.
        port: Port to listen on, as for ``PageServer``.
        token: Access token, as for ``PageServer``.
        hosts: Additional host names under which the server may be addressed.
        home: Folder for the captures and rooms created on the page. None uses the user's data
            folder.
        max_upload_bytes: Maximum size in bytes of an uploaded capture.
        capture: Path of the capture with the room's photos. None uses the path recorded in the
            room's folder.
        in_notebook: Whether notebooks of this machine may show the page in a frame.
        phone: Address of this machine on the local network, where a phone page is served besides.
            None serves none.
        tls: Certificate and key of the phone page, as for ``PageServer``.
        agents: The models that may walk in the room. None lets none walk.

    Raises:
        UsageError: If the port is taken, or if this machine does not have the address.
        InputError: If the certificate or its key cannot be used.
    """

    def __init__(
        self,
        editor: Editor | None = None,
        *,
        host: str = LOOPBACK,
        port: int | None = None,
        token: str | None = None,
        hosts: Iterable[str] = (),
        home: Path | None = None,
        max_upload_bytes: int = MAX_UPLOAD_BYTES,
        capture: Path | None = None,
        in_notebook: bool = False,
        phone: str | None = None,
        tls: tuple[Path, Path] | None = None,
        agents: WalkAgents | None = None,
    ):
        self.session = Session(editor)
        self.workspace = Workspace(
            self.session, home or user_home(), max_bytes=max_upload_bytes, capture=capture
        )
        is_open = not is_loopback(host)
        named = [*hosts, *([host, socket.gethostname()] if is_open else [])]

        def build(token: str, port: int) -> ASGIApp:
            """Create the application for the server's token and port."""
            return build_app(
                self.session,
                workspace=self.workspace,
                token=token,
                port=port,
                hosts=named,
                any_address=is_open,
                in_notebook=in_notebook,
                agents=agents,
            )

        super().__init__(build, host=host, port=port, token=token)
        self.phone = None if phone is None else PhoneServer(self.workspace, phone, tls)

    async def _serve(self, ready: Callable[[], None]) -> None:
        if self.phone is None:
            await super()._serve(ready)
            return
        beside = asyncio.create_task(self.phone.serve())
        try:
            await super()._serve(ready)
        finally:
            self.phone.end()
            await beside

    async def close(self) -> None:
        """Close the document."""
        await self.session.close()


def page_url(scheme: str, host: str, port: int) -> str:
    """Return the URL of a page, without a token."""
    shown = LOOPBACK if host in EVERY_ADDRESS else host
    return f"{scheme}://{f'[{shown}]' if ':' in shown else shown}:{port}/"


def _check_certificate(certificate: Path, key: Path) -> None:
    for path in (certificate, key):
        if not path.is_file():
            raise InputError(path, "not found; --tls needs the files of a certificate and its key")
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key, password=lambda: "")  # Nobody is asked.
    except (ssl.SSLError, OSError) as error:
        raise InputError(
            certificate,
            f"cannot be used with {key} ({error}); --tls needs a PEM certificate and its PEM key "
            "without a password",
        ) from error


def _listening(host: str, port: int | None, usual_port: int) -> socket.socket:
    if port is not None:
        return _bound(host, port)
    with suppress(UsageError):
        return _bound(host, usual_port)
    return _bound(host, 0)


def _bound(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    held = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # Elsewhere it would let a second server take the port.
            held.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        held.bind((host, port))
        held.listen(128)  # From here on a second server is refused.
    except (OSError, OverflowError) as error:
        held.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(
            f"cannot listen on {host}:{port} ({reason}); omit the port (--port) to use a free one"
        ) from error
    return held
