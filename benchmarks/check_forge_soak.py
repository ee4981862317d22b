"""A long day in the editor: thousands of edits from several tabs, and a server that is killed.

``python -m benchmarks.check_forge_soak [--edits 10000] [--tabs 5] [--every 500]``

A server of the demo room runs in a process of its own. Tabs edit at once: they paint, move, turn,
rename and delete, undo, redo and save. Each applies the changes that it is told to arrays of its
own, as the page does. After every 500 acknowledged edits the server is killed, every second time
in the midst of edits, and started again on the same folder. It must then open for editing with
every acknowledged edit and at most one more per tab. Each tab that had heard of the last revision
must hold the same cells as the new server. The memory of a server may not grow with the number of
edits before it.
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from world2minecraft.sceneforge.array_messages import HEADER

ROOT = Path(__file__).resolve().parents[1]
HANG_S, QUIET_S = 60.0, 1.0
ANSWERS = ("done", "refused")
MAX_GROWTH = 1.5  # Memory of the last server by that of the first.
LINK = "SceneForge: "
CLASSES = (2, 3, 5, 7, 8, 10, 11)


@dataclass
class Server:
    """A server process of the demo room in a folder."""

    home: Path
    link: str = field(default="", init=False)

    def start(self) -> None:
        """Start the process, and return when its page can be opened."""
        words = ["forge", "--demo", "--home", str(self.home), "--port", "0", "--no-browser"]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "world2minecraft", *words],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
        )  # fmt: skip
        told = []
        for line in self._process.stdout or ():
            told.append(line)
            if line.startswith(LINK):
                self.link = line.removeprefix(LINK).strip()
                return
        raise SystemExit(f"the server did not start:\n{''.join(told)}")

    def kill(self) -> float:
        """Kill the process; return the most memory that it held, in MB."""
        status = Path(f"/proc/{self._process.pid}/status").read_text()
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()
        return next(int(line.split()[1]) / 1024 for line in status.splitlines() if "VmHWM" in line)

    @property
    def url(self) -> str:
        """The address without its token."""
        return self.link.partition("?")[0]

    @property
    def headers(self) -> dict[str, str]:
        """What admits a script."""
        return {"Authorization": f"Bearer {self.link.partition('token=')[2]}"}

    def volumes(self) -> tuple[int, np.ndarray, np.ndarray]:
        """Return the revision, and the labels and owners of all cells."""
        rev, arrays = 0, []
        for what, kind in (("labels", np.uint8), ("instance", np.uint16)):
            answer = httpx.get(
                f"{self.url}api/volume", params={"what": what}, headers=self.headers, timeout=HANG_S
            )
            rev = int(answer.headers["x-rev"])
            arrays.append(np.frombuffer(answer.content[HEADER.size :], kind).copy())
        return rev, *arrays


@dataclass
class Tab:
    """One tab: what it was told, and what it asks for."""

    number: int
    moments: random.Random
    rev: int = 0
    acknowledged: int = 0
    ends: Counter = field(default_factory=Counter)
    labels: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint8))
    owners: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint16))
    objects: set[int] = field(default_factory=set)

    def work(self, server: Server, enough: threading.Event) -> None:
        """Edit until there is enough, or the server is gone."""
        live = f"{server.url.replace('http', 'ws', 1)}api/live"
        with (
            suppress(ConnectionClosed, OSError, TimeoutError),
            connect(live, additional_headers=server.headers, max_queue=None) as socket,
        ):
            while not enough.is_set():
                socket.send(json.dumps({**self._request(), "seq": self.ends.total()}))
                while (told := json.loads(socket.recv(timeout=HANG_S)))["type"] not in ANSWERS:
                    self._hear(told)
                self.ends[told["type"]] += 1
                if told["type"] == "done":
                    self.acknowledged = max(self.acknowledged, int(told["rev"]))
            while True:  # What the other tabs did last.
                self._hear(json.loads(socket.recv(timeout=QUIET_S)))

    def _hear(self, told: dict) -> None:
        if told["type"] != "change" or told["rev"] != self.rev + 1 or told["cells"] is None:
            return
        self.rev = told["rev"]
        for first, length, label, owner, _ in told["cells"]:
            self.labels[first : first + length] = label
            self.owners[first : first + length] = owner
        self.objects -= set(told["gone"])
        self.objects |= {one["id"] for one in told["objects"]}

    def _request(self) -> dict:
        draw, one = self.moments, self.moments.choice(sorted(self.objects) or [1])
        kind = draw.choices(
            ("paint", "turn", "rename", "move", "delete", "undo", "redo", "save"),
            (50, 8, 8, 8, 1, 14, 8, 3),
        )[0]
        if kind in ("undo", "redo", "save"):
            return {"type": kind}
        first = draw.randrange(len(self.labels) - 40)
        commands = {
            "paint": {
                "op": "set_cells",
                "cells": [[first, draw.randint(1, 40)]],
                "class_id": draw.choice(CLASSES),
            },
            "turn": {"op": "turn_objects", "ids": [one], "quarter_turns": draw.randint(1, 3)},
            "rename": {"op": "rename_objects", "ids": [one], "name": f"thing {first}"},
            "move": {"op": "move_object", "id": one, "to_m": [draw.uniform(0.5, 3.5)] * 3},
            "delete": {"op": "delete_objects", "ids": [one]},
        }
        return {"type": "do", "command": commands[kind]}


def main() -> int:
    """Edit and kill as often as asked; return 1 where something is wrong."""
    parser = argparse.ArgumentParser(description="Edit in several tabs, and kill the server.")
    parser.add_argument("--edits", type=int, default=10_000)
    parser.add_argument("--tabs", type=int, default=5)
    parser.add_argument("--every", type=int, default=500, help="edits between two kills")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    tabs = [Tab(n, random.Random(asked.seed * 100 + n)) for n in range(asked.tabs)]
    faults, memory_mb, compared, started = list[str](), list[float](), 0, time.monotonic()
    with tempfile.TemporaryDirectory() as scratch:
        server = Server(Path(scratch))
        server.start()
        show(server, tabs)
        while done(tabs) < asked.edits:
            wanted = min(done(tabs) + asked.every, asked.edits)
            memory_mb.append(edit(server, tabs, wanted, in_midst=len(memory_mb) % 2 == 1))
            server.start()
            rev, labels, owners = server.volumes()
            told = max(max(tab.acknowledged, tab.rev) for tab in tabs)
            if not told <= rev <= told + len(tabs):
                faults.append(f"revision {rev} after a kill at {told}")
            for tab in tabs:
                if tab.rev == rev:
                    compared += 1
                    same = (tab.labels == labels).all() and (tab.owners == owners).all()
                    if not same:
                        faults.append(f"tab {tab.number} holds other cells at revision {rev}")
            print(
                f"{done(tabs):>7,} edits, revision {rev:,}, {memory_mb[-1]:.0f} MB, "
                f"{len(faults)} faults",
                flush=True,
            )
            show(server, tabs)
        server.kill()
    if memory_mb[-1] > MAX_GROWTH * memory_mb[0]:
        faults.append(f"memory grew from {memory_mb[0]:.0f} to {memory_mb[-1]:.0f} MB")
    refused = sum(tab.ends["refused"] for tab in tabs)
    print(
        f"{done(tabs):,} edits in {len(tabs)} tabs and {refused:,} refused ones, "
        f"{len(memory_mb)} kills, {compared} comparisons, "
        f"{time.monotonic() - started:.0f} s\n{len(faults)} faults"
    )
    for fault in faults:
        print(fault)
    return 1 if faults else 0


def done(tabs: list[Tab]) -> int:
    """Return how many edits were acknowledged."""
    return sum(tab.ends["done"] for tab in tabs)


def show(server: Server, tabs: list[Tab]) -> None:
    """Let all tabs load the room again, as a page does when it is connected again."""
    rev, labels, owners = server.volumes()
    scene = httpx.get(f"{server.url}api/scene", headers=server.headers, timeout=HANG_S).json()
    for tab in tabs:
        tab.rev, tab.labels, tab.owners = rev, labels.copy(), owners.copy()
        tab.objects = {one["id"] for one in scene["objects"]}


def edit(server: Server, tabs: list[Tab], wanted: int, *, in_midst: bool) -> float:
    """Let the tabs edit until so many edits were acknowledged, kill the server, return its MB."""
    enough = threading.Event()
    threads = [threading.Thread(target=tab.work, args=(server, enough)) for tab in tabs]
    for thread in threads:
        thread.start()
    while done(tabs) < wanted and any(thread.is_alive() for thread in threads):
        time.sleep(0.01)
    megabytes = server.kill() if in_midst else 0.0
    enough.set()
    for thread in threads:
        thread.join()
    return megabytes or server.kill()


if __name__ == "__main__":
    sys.exit(main())
