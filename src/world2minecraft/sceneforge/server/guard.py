"""Access control for SceneForge, applied to every HTTP request and websocket connection.

Binding to loopback is not sufficient protection: any page that the user has open can send requests
to loopback, and DNS rebinding even lets it read the answers. Each request must therefore name an
allowed host (``Host``), come from the server's own page or from no page (``Origin``,
``Sec-Fetch-Site``), and present a 256-bit token. The token is part of the printed link. At the
first visit it is exchanged for a cookie that scripts cannot read and other sites do not send, and
is then removed from the address bar. Programs send the token as ``Authorization: Bearer TOKEN``
instead.

A server for a notebook may also be shown in a frame by pages of this machine. The page of the
notebook has another port, so browsers report such visits as ``same-site``.
"""

import json
import re
import secrets
from collections.abc import Callable, Iterable
from hmac import compare_digest
from http.cookies import CookieError, SimpleCookie
from ipaddress import ip_address
from urllib.parse import parse_qs

from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
TOKEN_BYTES = 32
HOST = re.compile(r"(?P<name>\[[0-9a-f:.]{2,45}\]|[a-z0-9_.-]{1,253})(?P<port>:[0-9]{1,5})?")
POLICY = (
    "default-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; "
    "style-src 'self' 'unsafe-inline'; connect-src 'self'; object-src 'none'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors "
)
NOTEBOOKS = "http://localhost:* http://127.0.0.1:*"
HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)
ALONE = (
    (b"content-security-policy", f"{POLICY}'none'".encode()),
    (b"x-frame-options", b"DENY"),
)
FRAMED = ((b"content-security-policy", f"{POLICY}{NOTEBOOKS}".encode()),)
POLICY_NAME = b"content-security-policy"
NO_STORE = (b"cache-control", b"no-store")
OWN_SITES = frozenset({"same-origin", "none"})
OPEN_THE_LINK = "open the link that w2m forge printed; it contains the access token"


class Guard:
    """The outermost ASGI middleware, which rejects all requests that do not come from the user.

    Args:
        app: The ASGI application to protect.
        token: Access token from ``new_token``, 43 characters, as contained in the link.
        port: Port of the server. It is part of the cookie's name, so that the cookies of two
            servers differ.
        hosts: Host names, besides those of loopback, under which the server may be addressed.
        any_address: Whether the ``Host`` header may also be any IP address. This is required if the
            server is not bound to loopback, and safe because DNS rebinding always uses a name.
        in_notebook: Whether pages of this machine may show the page in a frame and link to it.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        token: str,
        port: int,
        hosts: Iterable[str] = (),
        any_address: bool = False,
        in_notebook: bool = False,
    ):
        self.app, self.token, self.any_address = app, token, any_address
        self.in_notebook = in_notebook
        self.headers = (*HEADERS, *(FRAMED if in_notebook else ALONE))
        self.hosts = {*LOOPBACK, *(name.lower() for name in hosts)}
        self.cookie = f"w2m_forge_{port}"
        self.session = new_token()  # What the cookie holds: a token in the link is not it.

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on to the application, or reject it with status 403 and a reason."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        headers = headers_of(scope)
        send = with_headers(scope, send, self.headers)
        refusal = self._foreign(headers, is_visit=_is_visit(scope))
        if not refusal and self._brings_token(scope):
            await _welcome(send, f"{self.cookie}={self.session}")
            return
        refusal = refusal or self._unknown(headers)
        if refusal:
            await refuse(scope, receive, send, refusal)
            return
        await self.app(scope, receive, send)

    def _foreign(self, headers: dict[str, list[str]], *, is_visit: bool = False) -> str:
        """Return why a request is neither from the server's page nor from a program, or ""."""
        allowed = OWN_SITES
        if self.in_notebook and is_visit and headers.get("sec-fetch-mode") == ["navigate"]:
            allowed = allowed | {"same-site"}
        return foreign_reason(headers, self._is_ours, allowed=allowed)

    def _is_ours(self, host: str) -> bool:
        found = HOST.fullmatch(host)
        if not found:
            return False
        return found["name"] in self.hosts or (self.any_address and _is_address(found["name"]))

    def _brings_token(self, scope: Scope) -> bool:
        """Return whether a request is a visit to the printed link."""
        if not _is_visit(scope):
            return False
        brought = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        return len(brought) == 1 and is_same(brought[0], self.token)

    def _unknown(self, headers: dict[str, list[str]]) -> str:
        """Return why the sender is not authenticated, or an empty string."""
        for value in headers.get("authorization", []):
            scheme, _, given = value.partition(" ")
            if scheme.lower() == "bearer" and is_same(given.strip(), self.token):
                return ""
        for value in headers.get("cookie", []):
            if is_same(cookie_value(value, self.cookie), self.session):
                return ""
        return OPEN_THE_LINK


def foreign_reason(
    headers: dict[str, list[str]],
    is_ours: Callable[[str], bool],
    *,
    schemes: Iterable[str] = ("http", "https"),
    allowed: frozenset[str] = OWN_SITES,
) -> str:
    """Return why a request comes from another site or names another host, or an empty string.

    Args:
        headers: Values of the headers by name in lower case.
        is_ours: Function that returns whether a ``Host`` in lower case is this server.
        schemes: Schemes of the server's own origin.
        allowed: Allowed values of ``Sec-Fetch-Site``.
    """
    hosts = headers.get("host", [])
    if len(hosts) != 1 or not is_ours(hosts[0].lower()):
        return "unknown host name; use the link that w2m forge printed"
    own = {f"{scheme}://{hosts[0].lower()}" for scheme in schemes}
    if any(origin.lower() not in own for origin in headers.get("origin", [])):
        return "requests from other sites are not allowed"
    if not allowed.issuperset(headers.get("sec-fetch-site", [])):
        return "links from other sites are not allowed; paste the link into the address bar"
    return ""


def new_token() -> str:
    """Return a random 256-bit token as 43 characters that are safe in a URL."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def _is_visit(scope: Scope) -> bool:
    """Return whether a request asks for the page itself."""
    return scope["type"] == "http" and scope["method"] == "GET" and scope["path"] == "/"


def headers_of(scope: Scope) -> dict[str, list[str]]:
    """Return the values of a request's headers by name in lower case."""
    found: dict[str, list[str]] = {}
    for name, value in scope["headers"]:
        found.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
    return found


def cookie_value(header: str, name: str) -> str:
    """Return the value of a cookie in a ``Cookie`` header, or an empty string."""
    try:
        morsel = SimpleCookie(header).get(name)
    except CookieError:
        return ""
    return morsel.value if morsel else ""


def is_same(given: str, wanted: str) -> bool:
    """Return whether two secrets are equal, in a time that does not depend on them."""
    return compare_digest(given.encode(), wanted.encode())


def _is_address(name: str) -> bool:
    try:
        ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True


async def _welcome(send: Send, cookie: str) -> None:
    """Set the cookie and redirect to the page without the token in the address bar."""
    cookie_header = f"{cookie}; HttpOnly; SameSite=Strict; Path=/"
    headers = [
        (b"location", b"/"),
        (b"set-cookie", cookie_header.encode()),
        (b"content-length", b"0"),
    ]
    await send({"type": "http.response.start", "status": 303, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


async def refuse(scope: Scope, receive: Receive, send: Send, why: str, status: int = 403) -> None:
    """Answer with a status and a reason, or reject a websocket before it is opened."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": why})
        return
    is_api = scope["path"].startswith("/api/")
    body = (json.dumps({"error": why}) if is_api else f"SceneForge: {why}.\n").encode()
    kind = b"application/json" if is_api else b"text/plain; charset=utf-8"
    headers = [(b"content-type", kind), (b"content-length", str(len(body)).encode())]
    headers.append((b"connection", b"close"))  # What follows in the stream is not read.
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def with_headers(scope: Scope, send: Send, headers: Iterable[tuple[bytes, bytes]]) -> Send:
    """Return a ``send`` function that adds the security headers to every answer.

    An answer may have a policy of its own if that puts the page into a sandbox.
    """
    if scope["type"] != "http":
        return send
    always = [*headers, NO_STORE] if _never_kept(scope["path"]) else [*headers]

    async def adding(message: Message) -> None:
        """Send a message, with the headers added to the start of a response."""
        if message["type"] == "http.response.start":
            own = [(name.lower(), value) for name, value in message.get("headers", [])]
            boxed = any(
                name == POLICY_NAME and value.startswith(b"sandbox ") for name, value in own
            )
            added = [pair for pair in always if not (boxed and pair[0] == POLICY_NAME)]
            names = {name for name, _ in added}
            kept = [pair for pair in own if pair[0] not in names]
            message = {**message, "headers": [*kept, *added]}
        await send(message)

    return adding


def _never_kept(path: str) -> bool:
    return path == "/" or path.startswith("/api/")
