"""A local web page for watching walks and for walking manually.

The page shows the frames as a JPEG stream with a text, and sends pressed keys back. It is served on
the loopback interface only and requires the token in its URL. Neither a display server nor OpenGL
is needed.
"""

import io
import json
import queue
import secrets
import threading
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.types import Move

LOOPBACK = "127.0.0.1"
MAX_QUEUED_KEYS = 64  # Further keys are dropped.
IDLE_S = 5.0  # Seconds without a new frame after which a page gets the last one again.
SCALE = 3  # Magnification of frames on the page.
_PAGE = """<!doctype html><meta charset="utf-8"><title>World2Minecraft</title>
<style>body{{margin:1em auto;max-width:60em;font:16px sans-serif;background:#16181d;color:#eee;
text-align:center}}img{{image-rendering:pixelated;
width:min(100%,{width}px);max-height:72vh;object-fit:contain}}
#said{{white-space:pre-line;font-size:1.25em;min-height:3.6em;margin:0.5em}}#keys{{color:#999}}</style>
<p id="said" role="status"></p>
<img src="/frames?token={token}" alt="View of the agent">
<p id="keys">Use the arrow keys or W, A and D to walk and turn, and press space at the goal.</p>
<script>
addEventListener("keydown", e => {{
  if (e.repeat || e.ctrlKey || e.metaKey || e.altKey) return
  const key = e.key.length === 1 ? e.key.toLowerCase() : e.key
  if (key.startsWith("Arrow") || key === " ") e.preventDefault()
  fetch("/key?token={token}&key=" + encodeURIComponent(key), {{method: "POST"}}).catch(() => {{}})
}})
const listen = async () => {{
  for (let number = -1; ;) {{
    const told = await (await fetch("/text?token={token}&after=" + number)).json()
    if (!told.open) break
    number = told.number
    document.getElementById("said").textContent = told.text
  }}
}}
listen().catch(() => {{}}).finally(() => {{
  document.getElementById("keys").textContent = "The program has ended; close this page."
}})
</script>"""
PATIENCE_S = 600.0  # Seconds without a key press after which a walk ends.
KEYS = {
    "ArrowUp": Move.FORWARD,
    "w": Move.FORWARD,
    "ArrowLeft": Move.LEFT,
    "a": Move.LEFT,
    "ArrowRight": Move.RIGHT,
    "d": Move.RIGHT,
    " ": Move.STOP,
}


class Window:
    """A local web page that shows frames.

    ``link`` is the URL of the page, and ``keys`` is the queue of keys that were pressed in it.
    """

    def __init__(self, width_px: int = 224):
        self.keys: queue.Queue[str] = queue.Queue(MAX_QUEUED_KEYS)
        self._token, self._width_px = secrets.token_urlsafe(16), width_px * SCALE
        self._frame, self._number, self._changed = b"", 0, threading.Condition()
        self._text = ""
        self._is_open = True
        self._server = ThreadingHTTPServer((LOOPBACK, 0), _handler_of(self))
        self._server.daemon_threads = True
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def link(self) -> str:
        """The URL of the page, with its access token."""
        return f"http://{LOOPBACK}:{self._server.server_address[1]}/?token={self._token}"

    def show(self, frame: np.ndarray, text: str | None = None) -> None:
        """Show a frame on all open pages.

        Args:
            frame: The image as uint8 [H, W, 3].
            text: The text beside the image. None keeps the current text.
        """
        stream = io.BytesIO()
        Image.fromarray(frame).save(stream, "JPEG", quality=88)
        with self._changed:
            self._frame, self._number = stream.getvalue(), self._number + 1
            self._text = self._text if text is None else text
            self._changed.notify_all()

    def say(self, text: str) -> None:
        """Replace the text beside the current frame."""
        with self._changed:
            self._text, self._number = text, self._number + 1
            self._changed.notify_all()

    def close(self) -> None:
        """Stop the server. Open pages keep showing the last frame."""
        with self._changed:
            self._is_open = False
            self._changed.notify_all()
        self._server.shutdown()
        self._server.server_close()

    def page(self) -> bytes:
        """Return the HTML of the page."""
        return _PAGE.format(token=self._token, width=self._width_px).encode()

    def knows(self, token: str) -> bool:
        """Return whether a token equals the access token of the page."""
        return secrets.compare_digest(token.encode(), self._token.encode())

    def after(self, number: int) -> tuple[bytes, int]:
        """Wait for a frame with a number greater than ``number``.

        Returns:
            The latest JPEG and its number. The JPEG is empty before the first frame and after
            closing.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._number > number or not self._is_open, IDLE_S)
            return (self._frame if self._is_open else b""), self._number

    def words(self, after: str) -> bytes:
        """Wait for a text newer than number ``after``; return number, text and state as JSON."""
        number = int(after[:12]) if after.isascii() and after.isdigit() else -1
        with self._changed:
            self._changed.wait_for(lambda: self._number > number or not self._is_open, IDLE_S)
            message = {"number": self._number, "text": self._text, "open": self._is_open}
        return json.dumps(message).encode()


def _handler_of(window: Window) -> type[BaseHTTPRequestHandler]:
    """Return the HTTP request handler class of a window."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:  # The library's name.
            """Send the page, the stream of frames or the new text."""
            request = self._authorized_request()
            if request is None:
                return
            if request[0] == "/":
                self._send("text/html; charset=utf-8", window.page())
            elif request[0] == "/frames":
                self._stream()
            elif request[0] == "/text":
                self._send("application/json", window.words(request[1].get("after", [""])[0]))
            else:
                self.send_error(404)

        def do_POST(self) -> None:
            """Queue a key that was pressed in the page."""
            request = self._authorized_request()
            if request is None:
                return
            key = request[1].get("key", [""])[0][:16]
            if request[0] == "/key" and key and not window.keys.full():
                window.keys.put_nowait(key)
            self._send("text/plain", b"")

        def log_message(self, format: str, *args: Any) -> None:
            """Log nothing, because a log line would contain the token."""

        def _authorized_request(self) -> tuple[str, dict[str, list[str]]] | None:
            parts = urlsplit(self.path)
            words = parse_qs(parts.query)
            if window.knows(words.get("token", [""])[0]):
                return parts.path, words
            self.send_error(403, "access token missing or wrong")
            return None

        def _send(self, kind: str, body: bytes) -> None:
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Referrer-Policy", "no-referrer")
            self.end_headers()
            self.wfile.write(body)

        def _stream(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
            self.end_headers()
            number = 0
            with suppress(OSError):  # The page was closed.
                while True:
                    frame, number = window.after(number)
                    if not frame:
                        return
                    head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(frame)}"
                    self.wfile.write(head.encode() + b"\r\n\r\n" + frame + b"\r\n")

    return Handler


def wait_for_move(window: Window, patience_s: float = PATIENCE_S) -> Move:
    """Wait for a key press that maps to a move, and return the move.

    Args:
        window: The page in which keys are pressed.
        patience_s: Seconds to wait for each key press.

    Raises:
        UsageError: If no key is pressed in time.
    """
    while True:
        try:
            key = window.keys.get(timeout=patience_s)
        except queue.Empty:
            raise UsageError(
                f"no key was pressed within {patience_s:g} s; open {window.link} and use "
                "the keys there"
            ) from None
        if key in KEYS:
            return KEYS[key]
