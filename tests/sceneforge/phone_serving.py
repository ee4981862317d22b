"""A server with a phone page on loopback, and phones of it."""

from contextlib import contextmanager

import httpx
from forge_serving import HANG_S, served, small_editor

ONE = "/api/phone/captures"


@contextmanager
def phone_served(home):
    options = {"home": home, "max_upload_bytes": 4 << 20, "phone": "127.0.0.1"}
    with served(small_editor(), **options) as server:
        server.phone.access.new_code()
        yield server


def phone_browser(server) -> httpx.Client:
    """What the script of the phone page sends."""
    origin = server.phone.url.rstrip("/")
    return httpx.Client(base_url=origin, headers={"Origin": origin}, timeout=HANG_S)


@contextmanager
def paired(server):
    """A phone that was let in by a new code."""
    with phone_browser(server) as phone:
        token = server.phone.access.new_code().partition("#")[2]
        assert phone.post("/api/phone/pair", json={"token": token}).status_code == 200
        yield phone


def announced(phone, *files) -> httpx.Response:
    body = {"files": [{"path": path, "size": size} for path, size in files]}
    return phone.post(ONE, json=body)


def put_head(server, phone, number: str, start: int, length: int) -> bytes:
    """The head of a request that sends ``length`` more bytes of the first file of a capture."""
    lines = [
        f"PUT {ONE}/{number}/files/0?at={start} HTTP/1.1",
        f"Host: 127.0.0.1:{server.phone.port}",
        f"Origin: {server.phone.url.rstrip('/')}",
        "Cookie: " + "; ".join(f"{one.name}={one.value}" for one in phone.cookies.jar),
        f"Content-Length: {length}",
    ]
    return "\r\n".join([*lines, "", ""]).encode()
