"""Limits for requests: the size of a body, and the size and nesting depth of JSON.

Sizes are checked before any data is stored, by the ``Content-Length`` header if there is one, and
by counting the received bytes.
"""

import asyncio
import contextlib
import json
import re
from typing import Any

import numpy as np
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from world2minecraft.core.errors import UsageError

MAX_JSON_BYTES = 8 << 20  # 200,000 runs of a 64 M cell grid as text take 4 MB.
MAX_JSON_DEPTH = 32  # Commands have at most five.
MAX_UPLOAD_BYTES = 512 << 20
MAX_DRAINED_BYTES = 32 << 20  # Larger bodies are refused unread, at the price of a reset.
MAX_DRAIN_S = 20.0
UPLOADS = "/api/upload"  # Paths that begin so take files.
STRINGS = re.compile(rb'"(?:[^"\\]|\\.)*"', re.DOTALL)
SURROGATES = re.compile(rb"\\u[dD][89a-fA-F]|\xed[\xa0-\xbf]")  # Halves of a character.


class TooLargeError(Exception):
    """A request body is larger than the limit for its path."""


class BodyLimit:
    """An ASGI middleware that answers 413 to requests with too large a body.

    Args:
        app: The ASGI application to protect.
        json_bytes: Maximum body size in bytes.
        upload_bytes: Maximum body size in bytes for paths that start with ``/api/upload``.
    """

    def __init__(
        self,
        app: ASGIApp,
        json_bytes: int = MAX_JSON_BYTES,
        upload_bytes: int = MAX_UPLOAD_BYTES,
    ):
        self.app, self.json_bytes, self.upload_bytes = app, json_bytes, upload_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request to the application while counting the bytes of its body."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        most = self.upload_bytes if scope["path"].startswith(UPLOADS) else self.json_bytes
        headers = {name.lower(): value for name, value in scope["headers"]}
        if headers.get(b"content-encoding", b"identity").lower() not in (b"", b"identity"):
            await _answer(send, 415, "compressed bodies are not supported; upload a ZIP file")
            return
        length = _length(headers.get(b"content-length"))
        if length > most:
            if length <= MAX_DRAINED_BYTES:
                await drain(receive)
            await _answer(send, 413, _too_large(most))
            return
        await self._counted(scope, receive, send, most)

    async def _counted(self, scope: Scope, receive: Receive, send: Send, most: int) -> None:
        seen, began = 0, False

        async def counting() -> Message:
            nonlocal seen
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > most:
                raise TooLargeError
            return message

        async def noting(message: Message) -> None:
            nonlocal began
            began = True
            await send(message)

        try:
            await self.app(scope, counting, noting)
        except TooLargeError:
            if not began:
                await drain(receive)
                await _answer(send, 413, _too_large(most))


async def drain(receive: Receive) -> None:
    """Read the rest of a body and discard it, up to a size and for a limited time.

    A client that is still sending when the connection closes sees a reset in place of the answer.
    """
    left = MAX_DRAINED_BYTES
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(MAX_DRAIN_S):
            while left > 0 and (message := await receive()).get("more_body", False):
                left -= len(message["body"])


def parse_json(data: bytes | str) -> Any:
    """Parse JSON text and return its value.

    Raises:
        UsageError: If the text is not valid JSON, contains NaN or infinity, is larger than
            ``MAX_JSON_BYTES``, is nested more than ``MAX_JSON_DEPTH`` levels deep, or contains a
            surrogate without its pair, which no answer could repeat.
    """
    raw = data.encode("utf-8", "surrogatepass") if isinstance(data, str) else data
    if len(raw) > MAX_JSON_BYTES:
        raise UsageError(_too_large(MAX_JSON_BYTES))
    if _depth(raw) > MAX_JSON_DEPTH:
        raise UsageError(f"the JSON is nested more than {MAX_JSON_DEPTH} levels deep")
    try:
        value = json.loads(raw, parse_constant=_no_constant)
        if SURROGATES.search(raw):
            json.dumps(value, ensure_ascii=False).encode()
        return value
    except (ValueError, RecursionError) as error:
        raise UsageError(f"invalid JSON: {error}") from error


def _depth(raw: bytes) -> int:
    """Return the nesting depth of brackets outside strings."""
    signs = np.frombuffer(STRINGS.sub(b"", raw), np.uint8)
    opens = (signs == ord("[")) | (signs == ord("{"))
    closes = (signs == ord("]")) | (signs == ord("}"))
    steps = (opens.view(np.int8) - closes.view(np.int8))[opens | closes]
    return int(np.cumsum(steps, dtype=np.int64).max(initial=0))


def _no_constant(name: str) -> Any:
    raise ValueError(f"{name} is not allowed in JSON")


def _length(value: bytes | None) -> int:
    return int(value) if value is not None and value.isdigit() else 0


def _too_large(most: int) -> str:
    return f"the request is larger than {most >> 20} MB"


async def _answer(send: Send, status: int, why: str) -> None:
    body = json.dumps({"error": why}).encode()
    headers = [
        (b"content-type", b"application/json"),
        (b"content-length", str(len(body)).encode()),
        (b"connection", b"close"),
    ]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
