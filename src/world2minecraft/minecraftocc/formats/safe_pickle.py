"""Read and write pickles of arrays safely: a pickle is a program, and may be hostile.

Python's unpickler calls whatever a pickle names. ``read_pickle`` knows some fifty operations on a
stack, and of names only those by which numpy's arrays and numbers are made; they stand for values
of ours, so that no foreign byte reaches numpy but as the content of an array whose size was
checked. Each ``do_NAME`` of ``PickleMachine`` is one operation of the pickle protocols 0 to 5 by
the name that ``pickletools`` gives it. There is no operation that imports, looks up an attribute or
calls what was looked up.

``dump_pickle`` writes pickle protocol 3, the same bytes for the same values. Python's own pickler
names numpy's modules as the numpy that runs it does; numpy 2 moved them, and the loaders run on
numpy 1. Here they have the old names, which both know.
"""

import pickletools
import re
import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, reason_of
from world2minecraft.core.files import read_bytes

MAX_DEPTH = 100_000
_MODULES = ("numpy.core.multiarray", "numpy._core.multiarray")
_NUMERIC = ("numpy.core.numeric", "numpy._core.numeric")
_BUILTINS = ("builtins", "__builtin__")
_NAMES = {
    **{(module, "_reconstruct"): "reconstruct" for module in _MODULES},
    **{(module, "scalar"): "scalar" for module in _MODULES},
    **{(module, "_frombuffer"): "frombuffer" for module in _NUMERIC},
    ("numpy", "ndarray"): "ndarray",
    ("numpy", "dtype"): "dtype",
    ("_codecs", "encode"): "encode",
    ("collections", "OrderedDict"): "dict",
    **{(module, name): "bytes" for module in _BUILTINS for name in ("bytes", "bytearray")},
}
_CODE = re.compile(r"[<>=|]?[biufcSU?]\d{0,3}")
Value = Any  # np.ndarray, str, int, float, bool, None, or a list or tuple of them.
KINDS = "biuf"  # Of arrays: truth values, whole numbers, floats.
_RECONSTRUCT = b"cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\nK\x00\x85C\x01b\x87R"
_DTYPE = b"cnumpy\ndtype\n"
MAX_BYTES = 512 << 20  # A scene of 220 x 220 x 90 cells with float64 centres takes 105 MB.
MAX_OPERATIONS = 200_000  # A frame takes about a hundred.
_BROKEN = (ValueError, TypeError, KeyError, IndexError, OverflowError, MemoryError, AttributeError)


class PickleRefused(Exception):
    """A pickle asks for what arrays and plain values do not need."""


class Mark:
    """Where the members of a tuple, list or dict begin on the stack."""


class GlobalName:
    """A name that a pickle may call."""

    __slots__ = ("name",)

    def __init__(self, name: str):
        self.name = name


class DtypeValue:
    """An array's dtype while its state is not known yet."""

    __slots__ = ("dtype",)

    def __init__(self, code: Any):
        if not isinstance(code, str) or not _CODE.fullmatch(code):
            raise PickleRefused(f"has an array of {str(code)[:20]!r}")
        self.dtype = np.dtype(code)

    def build(self, state: Any) -> "DtypeValue":
        """Take the byte order; a dtype with fields or shapes is refused."""
        match state:
            case (_, "<" | ">" | "|" | "=" as order, None, None, None, *_):
                self.dtype = self.dtype.newbyteorder(order)
                return self
        raise PickleRefused("has an array of records")


class ArrayValue:
    """An array whose content is not known yet; an operation on the stack puts it in."""

    __slots__ = ("values",)

    def __init__(self):
        self.values: np.ndarray | None = None


def make_array(data: Any, dtype: Any, shape: Any, fortran: bool) -> np.ndarray:
    """Return an array of bytes, its size checked. Raises Refusal where it does not fit."""
    if isinstance(data, str):
        data = data.encode("latin-1")
    if not isinstance(dtype, DtypeValue) or not isinstance(data, (bytes, bytearray)):
        raise PickleRefused("has an array without bytes")
    sides = tuple(shape) if isinstance(shape, (tuple, list)) else (shape,)
    if not all(type(side) is int and 0 <= side < 1 << 32 for side in sides) or len(sides) > 8:
        raise PickleRefused("has an array of no shape")
    count = 1
    for side in sides:
        count *= side
    if count * dtype.dtype.itemsize != len(data):
        raise PickleRefused(f"has an array {sides} of {dtype.dtype} in {len(data):,} bytes")
    flat = np.frombuffer(bytearray(data), dtype.dtype)
    return flat.reshape(sides, order="F" if fortran else "C")


class PickleMachine:
    """The stack and the memo of one pickle."""

    def __init__(self):
        self.stack: list[Any] = []
        self.memo: dict[int, Any] = {}
        self.done = False

    def result(self) -> Any:
        """Return what the pickle stands for."""
        if not self.done or len(self.stack) != 1:
            raise PickleRefused("is a pickle that does not end")
        return self.stack[0]

    def push(self, value: Any) -> None:
        """Put a value on the stack."""
        if len(self.stack) > MAX_DEPTH:
            raise PickleRefused("is a pickle that piles up values")
        self.stack.append(value)

    def pop(self) -> Any:
        """Take the last value, which may not be a mark."""
        value = self.stack.pop()
        if isinstance(value, Mark):
            raise PickleRefused("is a pickle whose marks do not match")
        return value

    def marked(self) -> list[Any]:
        """Take all values since the last mark."""
        for index in range(len(self.stack) - 1, -1, -1):
            if isinstance(self.stack[index], Mark):
                values = self.stack[index + 1 :]
                del self.stack[index:]
                return values
        raise PickleRefused("is a pickle without a mark")

    # What makes a value out of nothing.

    def do_PROTO(self, argument: Any) -> None:
        """Say the protocol."""

    do_FRAME = do_PROTO

    def do_STOP(self, argument: Any) -> None:
        """End."""
        self.done = True

    def do_MARK(self, argument: Any) -> None:
        """Begin a tuple, a list or a dict."""
        self.push(Mark())

    def do_NONE(self, argument: Any) -> None:
        """Push None."""
        self.push(None)

    def do_NEWTRUE(self, argument: Any) -> None:
        """Push True."""
        self.push(True)

    def do_NEWFALSE(self, argument: Any) -> None:
        """Push False."""
        self.push(False)

    def do_INT(self, argument: Any) -> None:
        """Push what the operation carries: a number, a text, bytes."""
        self.push(argument)

    do_BININT = do_BININT1 = do_BININT2 = do_LONG = do_LONG1 = do_LONG4 = do_INT
    do_FLOAT = do_BINFLOAT = do_INT
    do_UNICODE = do_BINUNICODE = do_SHORT_BINUNICODE = do_BINUNICODE8 = do_INT
    do_STRING = do_BINSTRING = do_SHORT_BINSTRING = do_INT
    do_BINBYTES = do_SHORT_BINBYTES = do_BINBYTES8 = do_BYTEARRAY8 = do_INT

    # What joins values.

    def do_EMPTY_TUPLE(self, argument: Any) -> None:
        """Push ()."""
        self.push(())

    def do_TUPLE(self, argument: Any) -> None:
        """Join what was marked."""
        self.push(tuple(self.marked()))

    def do_TUPLE1(self, argument: Any) -> None:
        """Join one value."""
        self.push((self.pop(),))

    def do_TUPLE2(self, argument: Any) -> None:
        """Join two values."""
        last, first = self.pop(), self.pop()
        self.push((first, last))

    def do_TUPLE3(self, argument: Any) -> None:
        """Join three values."""
        last, middle, first = self.pop(), self.pop(), self.pop()
        self.push((first, middle, last))

    def do_EMPTY_LIST(self, argument: Any) -> None:
        """Push []."""
        self.push([])

    def do_LIST(self, argument: Any) -> None:
        """Join what was marked to a list."""
        self.push(self.marked())

    def do_APPEND(self, argument: Any) -> None:
        """Lengthen a list by one."""
        value = self.pop()
        self._list().append(value)

    def do_APPENDS(self, argument: Any) -> None:
        """Lengthen a list by what was marked."""
        values = self.marked()
        self._list().extend(values)

    def do_EMPTY_DICT(self, argument: Any) -> None:
        """Push {}."""
        self.push({})

    def do_DICT(self, argument: Any) -> None:
        """Join what was marked to a dict."""
        values = self.marked()
        self.push({})
        self._set(values)

    def do_SETITEM(self, argument: Any) -> None:
        """Set one key."""
        value, key = self.pop(), self.pop()
        self._set([key, value])

    def do_SETITEMS(self, argument: Any) -> None:
        """Set the keys that were marked."""
        self._set(self.marked())

    # The memo.

    def do_PUT(self, argument: Any) -> None:
        """Remember the last value by a number."""
        self.memo[int(argument)] = self.stack[-1]

    do_BINPUT = do_LONG_BINPUT = do_PUT

    def do_MEMOIZE(self, argument: Any) -> None:
        """Remember the last value by the next number."""
        self.memo[len(self.memo)] = self.stack[-1]

    def do_GET(self, argument: Any) -> None:
        """Push what was remembered."""
        self.push(self.memo[int(argument)])

    do_BINGET = do_LONG_BINGET = do_GET

    def do_POP(self, argument: Any) -> None:
        """Drop the last value."""
        self.stack.pop()

    # Names, and what stands for calling them.

    def do_GLOBAL(self, argument: Any) -> None:
        """Push one of the few names."""
        module, _, name = argument.partition(" ")
        self._name(module, name)

    def do_STACK_GLOBAL(self, argument: Any) -> None:
        """Push one of the few names, given by the last two texts."""
        name, module = self.pop(), self.pop()
        self._name(module, name)

    def do_REDUCE(self, argument: Any) -> None:
        """Make what a name and its arguments stand for."""
        arguments, named = self.pop(), self.pop()
        if not isinstance(named, GlobalName) or not isinstance(arguments, tuple):
            raise PickleRefused("calls what is no name")
        self.push(_reduce(named.name, arguments))

    def do_BUILD(self, argument: Any) -> None:
        """Give an array its content or a dtype its byte order."""
        state, value = self.pop(), self.stack[-1]
        if isinstance(value, DtypeValue):
            value.build(state)
        elif isinstance(value, ArrayValue) and isinstance(state, tuple) and len(state) == 5:
            _, shape, dtype, fortran, data = state
            value.values = make_array(data, dtype, shape, bool(fortran))
        else:
            raise PickleRefused(f"sets the state of a {type(value).__name__}")

    def _list(self) -> list[Any]:
        if not isinstance(self.stack[-1], list):
            raise PickleRefused("lengthens what is no list")
        return self.stack[-1]

    def _set(self, values: list[Any]) -> None:
        if not isinstance(self.stack[-1], dict) or len(values) % 2:
            raise PickleRefused("sets keys of what is no dict")
        self.stack[-1].update(zip(values[::2], values[1::2], strict=True))

    def _name(self, module: Any, name: Any) -> None:
        if (module, name) not in _NAMES:
            raise PickleRefused(f"names {str(module)[:60]}.{str(name)[:60]}, which no array needs")
        self.push(GlobalName(_NAMES[module, name]))


def _reduce(name: str, arguments: tuple[Any, ...]) -> Any:
    """Return what a call stands for, or refuse the arguments."""
    match name, arguments:
        case "reconstruct", (GlobalName(name="ndarray"), (0,), _):
            return ArrayValue()
        case "dtype", (code, *_):
            return DtypeValue(code)
        case "scalar", (DtypeValue() as dtype, data):
            return make_array(data, dtype, (), False)[()]
        case "frombuffer", (data, dtype, shape, order):
            return make_array(data, dtype, shape, order == "F")
        case "encode", (str() as text, "latin1" | "latin-1"):
            return text.encode("latin-1")
        case "dict", ():
            return {}
        case "bytes", ():
            return b""
        case "bytes", (bytes() as data,):
            return data
    raise PickleRefused(f"calls {name} as no array does")


def dump_pickle(values: Mapping[str, Value]) -> bytes:
    """Return the pickle of a dict.

    Raises:
        TypeError: a value, or a member of a list, is of no kind that loaders expect.

    Example:
        >>> import pickle
        >>> pickle.loads(dump_pickle({"name": "a", "shape": [60, 60, 36]}))
        {'name': 'a', 'shape': [60, 60, 36]}
    """
    parts = [b"\x80\x03}("]
    for name, value in values.items():
        parts += [_encode_text(name), _encode_value(value)]
    return b"".join([*parts, b"u."])


def _encode_value(value: Value) -> bytes:
    if value is None:
        return b"N"
    if isinstance(value, (bool, np.bool_)):
        return b"\x88" if value else b"\x89"
    if isinstance(value, str):
        return _encode_text(value)
    if isinstance(value, (int, np.integer)):
        return _encode_int(int(value))
    if isinstance(value, (float, np.floating)):
        return b"G" + struct.pack(">d", float(value))
    if isinstance(value, np.ndarray):
        return _encode_array(value)
    if isinstance(value, (list, tuple)):
        return b"](" + b"".join(_encode_value(member) for member in value) + b"e"
    raise TypeError(f"a pickle for other loaders holds no {type(value).__name__}")


def _encode_text(value: str) -> bytes:
    data = value.encode()
    return b"X" + struct.pack("<I", len(data)) + data


def _encode_int(value: int) -> bytes:
    if -(1 << 31) <= value < 1 << 31:
        return b"J" + struct.pack("<i", value)
    data = value.to_bytes(value.bit_length() // 8 + 1, "little", signed=True)
    return b"\x8a" + struct.pack("<B", len(data)) + data


def _encode_array(values: np.ndarray) -> bytes:
    """An array is made empty, then given its shape, its dtype and its bytes in C order."""
    if values.dtype.kind not in KINDS:
        raise TypeError(f"a pickle for other loaders holds no array of {values.dtype}")
    little = values.astype(values.dtype.newbyteorder("<"), order="C", copy=False)
    data = little.tobytes()
    order = b"X\x01\x00\x00\x00" + (b"|" if little.dtype.itemsize == 1 else b"<")
    code = _encode_text(f"{little.dtype.kind}{little.dtype.itemsize}")
    dtype = _DTYPE + code + b"\x89\x88\x87R(K\x03" + order + b"NNNJ\xff\xff\xff\xff"
    dtype += b"J\xff\xff\xff\xffK\x00tb"
    shape = b"(" + b"".join(_encode_int(side) for side in little.shape) + b"t"
    size = b"B" + struct.pack("<I", len(data)) + data
    return _RECONSTRUCT + b"(K\x01" + shape + dtype + b"\x89" + size + b"tb"


def read_pickle(path: str | Path, limit_bytes: int = MAX_BYTES) -> dict[str, Any]:
    """Read a pickled dict of arrays, texts, numbers and lists of them.

    Arrays are ndarrays that may be written to; tuples come back as lists.

    Raises:
        InputError: it is missing. LimitError: it is too large. DamagedFileError: it is no pickle,
            or names anything but arrays and plain values.
    """
    return parse_pickle(read_bytes(path, limit_bytes), path)


def parse_pickle(data: bytes, name: object = "pickle") -> dict[str, Any]:
    """Read the bytes of a pickled dict. Raises what ``read_pickle`` raises."""
    try:
        found = _interpret(data)
        if not isinstance(found, dict):
            raise PickleRefused(f"holds a {type(found).__name__}, not a dict")
        return {_key(key): _plain(value) for key, value in found.items()}
    except PickleRefused as error:
        raise DamagedFileError(name, f"{error}; it is not read") from error
    except _BROKEN as error:
        words = reason_of(error, 120)
        raise DamagedFileError(name, f"is no whole pickle ({words})") from error


def _interpret(data: bytes) -> Any:
    machine = PickleMachine()
    for count, (operation, argument, _) in enumerate(pickletools.genops(data)):
        if count > MAX_OPERATIONS:
            raise PickleRefused(f"is a program of over {MAX_OPERATIONS:,} steps")
        step: Callable[[Any], None] | None = getattr(machine, f"do_{operation.name}", None)
        if step is None:
            raise PickleRefused(f"is a pickle with {operation.name}, which no array needs")
        step(argument)
    return machine.result()


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise PickleRefused(f"has a key that is a {type(key).__name__}, not a text")
    return key


def _plain(value: Any, depth: int = 0) -> Any:
    """Return a value of ours as one of Python's or numpy's; lists lie at most three deep."""
    if isinstance(value, ArrayValue) and value.values is not None:
        return value.values
    if value is None or isinstance(value, (bool, int, float, str, bytes, np.ndarray, np.generic)):
        return value
    if isinstance(value, (list, tuple)) and depth < 3:
        return [_plain(member, depth + 1) for member in value]
    raise PickleRefused(f"holds a {type(value).__name__}")
