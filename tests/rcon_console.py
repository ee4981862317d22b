"""A server's remote console for tests: a dictionary of blocks behind the RCON protocol.

It is written from the protocol's page and the game's messages, not from the client: a packet must
come whole in one read of 1,460 bytes, as the game has it, else it hangs up.
"""

import re
import socket
import struct
import threading

from world2minecraft.minecraft.block_states import complete, parse_state

POINT = r"(-?\d+) (-?\d+) (-?\d+)"


class Console:
    """Listens on a free port; ``cuts`` are the numbers of commands before which it hangs up."""

    def __init__(self, password="secret", cuts=(), deaf_to=None, load_after=0, is_old=False):
        self.password, self.cuts, self.deaf_to = password, set(cuts), deaf_to
        self.load_after, self.is_old = load_after, is_old
        self.blocks, self.entities, self.commands, self.forced = {}, [], [], []
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = self._server.getsockname()[1]
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        if self._server.fileno() >= 0:
            self._server.shutdown(socket.SHUT_RDWR)  # Else accept keeps the port open.
            self._server.close()
        self._thread.join(5)

    def _serve(self):
        while True:
            try:
                line, _ = self._server.accept()
            except OSError:
                return
            with line:
                self._talk(line)

    def _talk(self, line):
        known = False
        while True:
            try:
                data = line.recv(1460)
            except OSError:
                return
            if len(data) < 14 or struct.unpack("<i", data[:4])[0] != len(data) - 4:
                return
            number, kind = struct.unpack("<ii", data[4:12])
            text = data[12:-2].decode()
            if kind == 3:
                known = text == self.password
                self._send(line, number if known else -1, 2, "")
                continue
            if not known:
                return self._send(line, -1, 2, "")
            if len(self.commands) in self.cuts:
                self.cuts.discard(len(self.commands))
                return None
            self.commands.append(text)
            reply = self.answer(text)
            for at in range(0, max(len(reply), 1), 4096):
                self._send(line, number, 0, reply[at : at + 4096])

    @staticmethod
    def _send(line, number, kind, text):
        body = text.encode()
        line.sendall(struct.pack("<iii", len(body) + 10, number, kind) + body + b"\0\0")

    def answer(self, text):
        if text == "help":
            return "help " * 2000
        if found := re.fullmatch(f"setblock {POINT} (.+)", text):
            *place, state = found.groups()
            return self._set([tuple(map(int, place))], state, "Changed the block", "Could not set")
        if found := re.fullmatch(f"fill {POINT} {POINT} (.+)", text):
            *ends, state = found.groups()
            x0, y0, z0, x1, y1, z1 = map(int, ends)
            box = [
                (x, y, z)
                for x in range(x0, x1 + 1)
                for y in range(y0, y1 + 1)
                for z in range(z0, z1 + 1)
            ]
            if len(box) > 32768:
                return (
                    f"Too many blocks in the specified area (maximum 32768, specified {len(box)})"
                )
            return self._set(box, state, "Successfully filled", "No blocks were filled")
        if self.is_old and text.startswith("execute if loaded"):
            return "Incorrect argument for command at position 11: execute if loaded<--[HERE]"
        if found := re.fullmatch(f"execute if loaded {POINT}", text):
            self.load_after -= 1
            return "Test passed" if self.load_after < 0 else "Test failed"
        if found := re.fullmatch(f"execute if block {POINT} (.+)", text):
            *place, state = found.groups()
            there = parse_state(self.blocks.get(tuple(map(int, place)), "minecraft:air"))
            asked = parse_state(state)  # The game compares what is stated, and no more.
            same = there.name == asked.name and set(asked.properties) <= set(there.properties)
            return "Test passed" if same else "Test failed"
        if text.startswith("forceload add"):
            self.forced.append(text)
            return "Marked 4 chunks in minecraft:overworld from [0, 0] to [1, 1] to be force loaded"
        if text.startswith("forceload remove"):
            self.forced.remove(text.replace("remove", "add"))
            return "Unmarked 4 chunks"
        if text.startswith("kill @e[tag="):
            tag = text[len("kill @e[tag=") : -1]
            self.entities = [e for e in self.entities if tag not in e]
            return "No entity was found"
        if text.startswith("summon "):
            self.entities.append(text)
            return "Summoned new Block Display"
        if text.startswith("data merge block"):
            return "Modified block data"
        return "Unknown or incomplete command, see below for error<--[HERE]"

    def _set(self, places, state, done, same):
        if not state.startswith("minecraft:"):
            return f"Unknown block type '{state}'"
        if self.deaf_to and self.deaf_to in state:
            return same
        for place in places:
            self.blocks[place] = _whole(state)
            if state == "minecraft:air":
                del self.blocks[place]
        return done


def _whole(state):
    return str(complete(parse_state(state)))
