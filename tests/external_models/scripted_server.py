"""A chat server that says what a script tells it, and misbehaves in every way that a test needs.

A script is a function of the request (its JSON) and its number; it returns a text, which becomes a
proper reply, or an ``Answer`` with a status, headers, a body and pauses of its own.
"""

import json
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


@dataclass(frozen=True)
class Answer:
    """What goes over the wire. ``pause_s`` is waited before each piece of the body."""

    status: int = 200
    body: bytes = b"{}"
    headers: dict = field(default_factory=dict)
    pause_s: float = 0.0
    piece: int = 1 << 20


def completion(text, *, prompt_tokens=100, completion_tokens=10, finish="stop"):
    """The JSON of a proper reply."""
    return {
        "id": "scripted",
        "object": "chat.completion",
        "created": 0,
        "model": "scripted",
        "choices": [
            {
                "index": 0,
                "message": {"role": "assistant", "content": text},
                "finish_reason": finish,
            }
        ],
        "usage": {
            "prompt_tokens": prompt_tokens,
            "completion_tokens": completion_tokens,
            "total_tokens": prompt_tokens + completion_tokens,
        },
    }


def proper(text, **more):
    return Answer(body=json.dumps(completion(text, **more)).encode())


BUSY = Answer(429, b'{"error": {"message": "slow down"}}', {"Retry-After": "0"})
NO_SCHEMA = Answer(400, b'{"error": {"message": "response_format is not supported"}}')
MEGABYTE = proper("x" * (1 << 20))
SLOW = Answer(body=b" " * 50, pause_s=0.1, piece=1)


class Scripted:
    """The server: ``requests`` are the bodies that came, ``url`` is its address."""

    def __init__(self, script, models=("scripted",)):
        self.requests, self.headers, self.script, self.models = [], [], script, models
        self._lock = threading.Lock()
        outer = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                listed = [{"id": name, "object": "model"} for name in outer.models]
                self._send(Answer(body=json.dumps({"object": "list", "data": listed}).encode()))

            def do_POST(self):
                asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                with outer._lock:
                    number = len(outer.requests)
                    outer.requests.append(asked)
                    outer.headers.append({k.lower(): v for k, v in self.headers.items()})
                said = outer.script(asked, number)
                self._send(proper(said) if isinstance(said, str) else said)

            def _send(self, answer):
                try:
                    self.send_response(answer.status)
                    self.send_header("Content-Type", "application/json")
                    self.send_header("Content-Length", str(len(answer.body)))
                    for name, value in answer.headers.items():
                        self.send_header(name, value)
                    self.end_headers()
                    for start in range(0, len(answer.body), answer.piece):
                        time.sleep(answer.pause_s)
                        self.wfile.write(answer.body[start : start + answer.piece])
                        self.wfile.flush()
                except OSError:
                    self.close_connection = True  # The client had enough.

            def log_message(self, *words):
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/v1"
        threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True).start()

    def close(self):
        self._server.shutdown()
        self._server.server_close()


@contextmanager
def scripted(script, models=("scripted",)):
    """Serve a script while the block runs; a list is one answer a request, the last for ever."""
    answers = script
    if isinstance(script, list):

        def in_turn(_asked, number):
            return answers[min(number, len(answers) - 1)]

        script = in_turn
    server = Scripted(script, models)
    try:
        yield server
    finally:
        server.close()
