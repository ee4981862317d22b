"""Two servers that commands speak to: a game's console, and a model that says what it is told to.

Both answer in the same way whoever asks, and write down what they were asked.
"""

import contextlib
import hashlib
import json
import re
import shlex
import socket
import struct
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from compare_outputs.acting import Place

PASSWORD = "secret"  # Of the console; Side.environment gives it to the command.
ECHO = "the last line again"
_POINT = r"(-?\d+) (-?\d+) (-?\d+)"


@dataclass(frozen=True)
class Console:
    """Run a command that builds on a server; ``{port}`` in its words is the console's port.

    What the console was told is written to ``console.txt``.
    """

    words: str

    def act(self, place: Place) -> int:
        """Do it."""
        with _GameConsole() as console:
            code = place.command(shlex.split(self.words.replace("{port}", str(console.port))))
        (place.folder / "console.txt").write_text("\n".join(console.told) + "\n")
        return code


class _GameConsole:
    """The RCON protocol before a dictionary of blocks; a full state is what was set."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.blocks: dict[tuple[int, ...], str] = {}
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        self.thread = threading.Thread(target=self.serve, daemon=True)

    def __enter__(self) -> "_GameConsole":
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.server.shutdown(socket.SHUT_RDWR)
        self.server.close()
        self.thread.join(5)

    def serve(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                line, _ = self.server.accept()
                with line, contextlib.suppress(OSError, struct.error):
                    self.talk(line)

    def talk(self, line: socket.socket) -> None:
        while data := line.recv(1460):
            number, kind = struct.unpack("<ii", data[4:12])
            text = data[12:-2].decode()
            if kind == 3:
                self.send(line, number if text == PASSWORD else -1, 2, "")
                continue
            self.told.append(text)
            self.send(line, number, 0, self.answer(text))

    @staticmethod
    def send(line: socket.socket, number: int, kind: int, text: str) -> None:
        body = text.encode()
        line.sendall(struct.pack("<iii", len(body) + 10, number, kind) + body + b"\0\0")

    def answer(self, text: str) -> str:
        if found := re.fullmatch(f"setblock {_POINT} (.+)", text):
            self.blocks[tuple(map(int, found.groups()[:3]))] = found[4]
            return "Changed the block"
        if found := re.fullmatch(f"fill {_POINT} {_POINT} (.+)", text):
            x0, y0, z0, x1, y1, z1 = map(int, found.groups()[:6])
            for x in range(x0, x1 + 1):
                for y in range(y0, y1 + 1):
                    for z in range(z0, z1 + 1):
                        self.blocks[x, y, z] = found[7]
            return "Successfully filled"
        if text.startswith("execute if loaded"):
            return "Test passed"
        if found := re.fullmatch(f"execute if block {_POINT} (.+)", text):
            there = self.blocks.get(tuple(map(int, found.groups()[:3])), "minecraft:air")
            return "Test passed" if _has(there, found[4]) else "Test failed"
        replies = {"forceload add": "Marked 1 chunk", "forceload remove": "Unmarked 1 chunk"}
        replies |= {"kill @e": "No entity was found", "summon ": "Summoned new Block Display"}
        replies |= {"data merge block": "Modified block data", "help": "help"}
        known = [reply for start, reply in replies.items() if text.startswith(start)]
        return known[0] if known else "Unknown or incomplete command, see below for error<--[HERE]"


def _has(state: str, asked: str) -> bool:
    """Whether a state that was set has the name and the properties that are asked for."""
    (name, there), (wanted, properties) = (_parts(one) for one in (state, asked))
    return name == wanted and properties <= there


def _parts(state: str) -> tuple[str, set[str]]:
    name, _, rest = state.partition("[")
    return name, set(rest.rstrip("]").split(",")) - {""}


@dataclass(frozen=True)
class Model:
    """Run a command that asks a model; ``{url}`` in its words is the model's address.

    replies: what it says, in turn and from the first again; ``ECHO`` is the last line of what it
    was asked. What it was asked is added to ``asked.jsonl``, pictures as their sums.
    """

    words: str
    replies: tuple[str, ...]

    def act(self, place: Place) -> int:
        """Do it."""
        with _model(self.replies) as (port, asked):
            words = self.words.replace("{url}", f"http://127.0.0.1:{port}/v1")
            code = place.command(shlex.split(words))
        lines = [json.dumps(one, sort_keys=True) + "\n" for one in asked]
        with (place.folder / "asked.jsonl").open("a", encoding="utf-8") as file:
            file.writelines(lines)
        return code


@contextlib.contextmanager
def _model(replies: tuple[str, ...]) -> Iterator[tuple[int, list[Any]]]:
    asked: list[Any] = []

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self) -> None:
            self.say({"object": "list", "data": [{"id": "scripted", "object": "model"}]})

        def do_POST(self) -> None:
            told = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            asked.append(_without_pictures(told))
            text = replies[(len(asked) - 1) % len(replies)]
            text = _last_line(told) if text == ECHO else text
            message = {"role": "assistant", "content": text}
            self.say(
                {
                    "id": "scripted",
                    "object": "chat.completion",
                    "created": 0,
                    "model": "scripted",
                    "choices": [{"index": 0, "message": message, "finish_reason": "stop"}],
                    "usage": {"prompt_tokens": 9, "completion_tokens": 1, "total_tokens": 10},
                }
            )

        def say(self, value: Any) -> None:
            body = json.dumps(value).encode()
            self.send_response(200)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server.server_address[1], asked
    finally:
        server.shutdown()
        server.server_close()
        thread.join(5)


def _last_line(told: dict[str, Any]) -> str:
    content = told["messages"][-1]["content"]
    if isinstance(content, list):
        content = "\n".join(part.get("text", "") for part in content)
    return content.strip().splitlines()[-1]


def _without_pictures(value: Any) -> Any:
    """Return a question with a sum in place of each picture."""
    if isinstance(value, dict):
        return {key: _without_pictures(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_without_pictures(one) for one in value]
    if isinstance(value, str) and value.startswith("data:"):
        return hashlib.sha256(value.encode()).hexdigest()
    return value
