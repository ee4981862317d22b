"""Just enough NBT to say where two of the game's files differ: values as plain Python ones."""

import struct
from typing import Any

_NUMBERS = {1: ">b", 2: ">h", 3: ">i", 4: ">q", 5: ">f", 6: ">d"}
_ARRAYS = {7: "b", 11: "i", 12: "q"}


def read_nbt(data: bytes, little: bool = False) -> Any:
    """Return the value of the one named tag that ``data`` holds; Bedrock's files are ``little``."""
    return _Reader(data, little).root()


class _Reader:
    def __init__(self, data: bytes, little: bool):
        self.data, self.at, self.order = data, 0, "<" if little else ">"

    def root(self) -> Any:
        kind = self.number("b")
        self.text()
        return self.value(kind)

    def number(self, code: str) -> Any:
        size = struct.calcsize(code)
        (value,) = struct.unpack_from(self.order + code, self.data, self.at)
        self.at += size
        return value

    def text(self) -> str:
        length = self.number("H")
        self.at += length
        return self.data[self.at - length : self.at].decode("utf-8", "surrogatepass")

    def value(self, kind: int) -> Any:
        if kind in _NUMBERS:
            return self.number(_NUMBERS[kind][1])
        if kind in _ARRAYS:
            length = self.number("i")
            values = struct.unpack_from(f"{self.order}{length}{_ARRAYS[kind]}", self.data, self.at)
            self.at += length * struct.calcsize(_ARRAYS[kind])
            return list(values)
        if kind == 8:
            return self.text()
        if kind == 9:
            inner, length = self.number("b"), self.number("i")
            return [self.value(inner) for _ in range(length)]
        if kind == 10:
            compound: dict[str, Any] = {}
            while inner := self.number("b"):
                name = self.text()
                compound[name] = self.value(inner)
            return compound
        raise ValueError(f"no NBT: a tag of kind {kind}")
