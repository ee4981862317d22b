"""Safe reading and writing of pickled arrays.

A pickle is a program, and Python's unpickler calls any function that a pickle names.
``read_pickle`` therefore uses its own interpreter, which supports about fifty stack operations and
only those names from which numpy arrays and numbers are built. Untrusted bytes reach numpy only as
the content of an array whose size was checked. Each method ``do_NAME`` of ``PickleMachine``
implements the operation NAME of the pickle protocols 0 to 5, named as in ``pickletools``. No
operation imports a module, looks up an attribute or calls an object from the pickle.

``dump_pickle`` writes pickle protocol 3, with identical bytes for identical values. Python's own
pickler writes the module names of the installed numpy version; numpy 2 renamed these modules, but
the published loaders run on numpy 1. ``dump_pickle`` uses the old names, which both versions
accept.
"""

import pickletools
import re
import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, reason_of
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
_BROKEN = (*MALFORMED, MemoryError, RecursionError)


class PickleRefused(Exception):
    """A pickle contains something other than arrays and plain values."""


class Mark:
    """A stack marker for the start of a tuple, list or dict."""


class GlobalName:
    """A supported global name that a pickle may call."""

    __slots__ = ("name",)

    def __init__(self, name: str):
        self.name = name


class DtypeValue:
    """The dtype of an array, before its byte order is known."""

    __slots__ = ("dtype",)

    def __init__(self, code: Any):
        if not isinstance(code, str) or not _CODE.fullmatch(code):
            raise PickleRefused(f"contains an array with the unsupported dtype {str(code)[:20]!r}")
        self.dtype = np.dtype(code)

    def build(self, state: Any) -> "DtypeValue":
        """Set the byte order.

        Raises:
            PickleRefused: If the dtype has fields or subarrays.
        """
        match state:
            case (_, "<" | ">" | "|" | "=" as order, None, None, None, *_):
                self.dtype = self.dtype.newbyteorder(order)
                return self
        raise PickleRefused("contains a structured array, which is not supported")


class ArrayValue:
    """An array whose content is not known yet. A later stack operation sets it."""

    __slots__ = ("values",)

    def __init__(self):
        self.values: np.ndarray | None = None


def make_array(data: Any, dtype: Any, shape: Any, fortran: bool) -> np.ndarray:
    """Create an array from raw bytes after checking their size.

    Raises:
        PickleRefused: If the dtype, the shape and the bytes do not match.
    """
    if isinstance(data, str):
        data = data.encode("latin-1")
    if not isinstance(dtype, DtypeValue) or not isinstance(data, (bytes, bytearray)):
        raise PickleRefused("contains an array without data")
    sides = tuple(shape) if isinstance(shape, (tuple, list)) else (shape,)
    if not all(type(side) is int and 0 <= side < 1 << 32 for side in sides) or len(sides) > 8:
        raise PickleRefused("contains an array without a valid shape")
    count = 1
    for side in sides:
        count *= side
    if count * dtype.dtype.itemsize != len(data):
        raise PickleRefused(
            f"contains a {dtype.dtype} array of shape {sides} with {len(data):,} bytes"
        )
    flat = np.frombuffer(bytearray(data), dtype.dtype)
    return flat.reshape(sides, order="F" if fortran else "C")


class PickleMachine:
    """The stack and memo of a pickle that is being read."""

    def __init__(self):
        self.stack: list[Any] = []
        self.memo: dict[int, Any] = {}
        self.done = False

    def result(self) -> Any:
        """Return the value of the complete pickle."""
        if not self.done or len(self.stack) != 1:
            raise PickleRefused("incomplete pickle")
        return self.stack[0]

    def push(self, value: Any) -> None:
        """Push a value onto the stack."""
        if len(self.stack) > MAX_DEPTH:
            raise PickleRefused("pickle with too many values on its stack")
        self.stack.append(value)

    def pop(self) -> Any:
        """Pop the last value, which must not be a mark."""
        value = self.stack.pop()
        if isinstance(value, Mark):
            raise PickleRefused("pickle with mismatched marks")
        return value

    def marked(self) -> list[Any]:
        """Pop all values after the last mark."""
        for index in range(len(self.stack) - 1, -1, -1):
            if isinstance(self.stack[index], Mark):
                values = self.stack[index + 1 :]
                del self.stack[index:]
                return values
        raise PickleRefused("pickle with a missing mark")

    # What makes a value out of nothing.

    def do_PROTO(self, argument: Any) -> None:
        """Ignore the protocol number."""

    do_FRAME = do_PROTO

    def do_STOP(self, argument: Any) -> None:
        """Mark the pickle as complete."""
        self.done = True

    def do_MARK(self, argument: Any) -> None:
        """Push a mark."""
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
        """Push the argument of the operation: a number, a string or bytes."""
        self.push(argument)

    do_BININT = do_BININT1 = do_BININT2 = do_LONG = do_LONG1 = do_LONG4 = do_INT
    do_FLOAT = do_BINFLOAT = do_INT
    do_UNICODE = do_BINUNICODE = do_SHORT_BINUNICODE = do_BINUNICODE8 = do_INT
    do_STRING = do_BINSTRING = do_SHORT_BINSTRING = do_INT
    do_BINBYTES = do_SHORT_BINBYTES = do_BINBYTES8 = do_BYTEARRAY8 = do_INT

    # What joins values.

    def do_EMPTY_TUPLE(self, argument: Any) -> None:
        """Push an empty tuple."""
        self.push(())

    def do_TUPLE(self, argument: Any) -> None:
        """Combine the values after the last mark into a tuple."""
        self.push(tuple(self.marked()))

    def do_TUPLE1(self, argument: Any) -> None:
        """Combine the last value into a tuple."""
        self.push((self.pop(),))

    def do_TUPLE2(self, argument: Any) -> None:
        """Combine the last two values into a tuple."""
        last, first = self.pop(), self.pop()
        self.push((first, last))

    def do_TUPLE3(self, argument: Any) -> None:
        """Combine the last three values into a tuple."""
        last, middle, first = self.pop(), self.pop(), self.pop()
        self.push((first, middle, last))

    def do_EMPTY_LIST(self, argument: Any) -> None:
        """Push an empty list."""
        self.push([])

    def do_LIST(self, argument: Any) -> None:
        """Combine the values after the last mark into a list."""
        self.push(self.marked())

    def do_APPEND(self, argument: Any) -> None:
        """Append the last value to a list."""
        value = self.pop()
        self._list().append(value)

    def do_APPENDS(self, argument: Any) -> None:
        """Append the values after the last mark to a list."""
        values = self.marked()
        self._list().extend(values)

    def do_EMPTY_DICT(self, argument: Any) -> None:
        """Push an empty dict."""
        self.push({})

    def do_DICT(self, argument: Any) -> None:
        """Combine the keys and values after the last mark into a dict."""
        values = self.marked()
        self.push({})
        self._set(values)

    def do_SETITEM(self, argument: Any) -> None:
        """Set a key of a dict."""
        value, key = self.pop(), self.pop()
        self._set([key, value])

    def do_SETITEMS(self, argument: Any) -> None:
        """Set the keys and values after the last mark in a dict."""
        self._set(self.marked())

    # The memo.

    def do_PUT(self, argument: Any) -> None:
        """Store the last value in the memo under a given number."""
        self.memo[int(argument)] = self.stack[-1]

    do_BINPUT = do_LONG_BINPUT = do_PUT

    def do_MEMOIZE(self, argument: Any) -> None:
        """Store the last value in the memo under the next number."""
        self.memo[len(self.memo)] = self.stack[-1]

    def do_GET(self, argument: Any) -> None:
        """Push a value from the memo."""
        self.push(self.memo[int(argument)])

    do_BINGET = do_LONG_BINGET = do_GET

    def do_POP(self, argument: Any) -> None:
        """Discard the last value."""
        self.stack.pop()

    # Names, and what stands for calling them.

    def do_GLOBAL(self, argument: Any) -> None:
        """Push a supported global name."""
        module, _, name = argument.partition(" ")
        self._name(module, name)

    def do_STACK_GLOBAL(self, argument: Any) -> None:
        """Push a supported global name that is given by the last two strings on the stack."""
        name, module = self.pop(), self.pop()
        self._name(module, name)

    def do_REDUCE(self, argument: Any) -> None:
        """Create the value that a supported name and its arguments describe."""
        arguments, named = self.pop(), self.pop()
        if not isinstance(named, GlobalName) or not isinstance(arguments, tuple):
            raise PickleRefused("calls an object that is not a supported name")
        self.push(_reduce(named.name, arguments))

    def do_BUILD(self, argument: Any) -> None:
        """Set the content of an array, or the byte order of a dtype."""
        state, value = self.pop(), self.stack[-1]
        if isinstance(value, DtypeValue):
            value.build(state)
        elif isinstance(value, ArrayValue) and isinstance(state, tuple) and len(state) == 5:
            _, shape, dtype, fortran, data = state
            value.values = make_array(data, dtype, shape, bool(fortran))
        else:
            raise PickleRefused(f"sets the state of an unsupported {type(value).__name__}")

    def _list(self) -> list[Any]:
        if not isinstance(self.stack[-1], list):
            raise PickleRefused("appends to a value that is not a list")
        return self.stack[-1]

    def _set(self, values: list[Any]) -> None:
        if not isinstance(self.stack[-1], dict) or len(values) % 2:
            raise PickleRefused("sets keys of a value that is not a dict")
        for key in values[::2]:  # A hash of deeply nested tuples would overflow the stack.
            if not isinstance(key, str):
                raise PickleRefused(
                    f"contains a key of type {type(key).__name__}, expected a string"
                )
        self.stack[-1].update(zip(values[::2], values[1::2], strict=True))

    def _name(self, module: Any, name: Any) -> None:
        if not isinstance(module, str) or not isinstance(name, str):
            raise PickleRefused("refers to a name that is not a string")
        if (module, name) not in _NAMES:
            raise PickleRefused(f"refers to {module[:60]}.{name[:60]}, which is not allowed")
        self.push(GlobalName(_NAMES[module, name]))


def _reduce(name: str, arguments: tuple[Any, ...]) -> Any:
    """Return the value that a call describes.

    Raises:
        PickleRefused: If the arguments are not supported.
    """
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
    raise PickleRefused(f"calls {name} with unsupported arguments")


def dump_pickle(values: Mapping[str, Value]) -> bytes:
    """Pickle a dict.

    Raises:
        TypeError: If a value or list member has a type that the published loaders do not expect.

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
    raise TypeError(f"cannot pickle a {type(value).__name__} for the published loaders")


def _encode_text(value: str) -> bytes:
    data = value.encode()
    return b"X" + struct.pack("<I", len(data)) + data


def _encode_int(value: int) -> bytes:
    if -(1 << 31) <= value < 1 << 31:
        return b"J" + struct.pack("<i", value)
    data = value.to_bytes(value.bit_length() // 8 + 1, "little", signed=True)
    return b"\x8a" + struct.pack("<B", len(data)) + data


def _encode_array(values: np.ndarray) -> bytes:
    """Encode an array: create it empty, then set its shape, its dtype and its bytes in C order."""
    if values.dtype.kind not in KINDS:
        raise TypeError(f"cannot pickle an array of {values.dtype} for the published loaders")
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
    """Read a pickled dict of arrays, strings, numbers and lists of these.

    Arrays are returned as writable ndarrays and tuples as lists.

    Args:
        path: Pickle file.
        limit_bytes: Maximum file size in bytes.

    Raises:
        InputError: If the file does not exist.
        LimitError: If the file is too large.
        DamagedFileError: If the file is not a pickle, or contains anything but arrays and plain
            values.
    """
    return parse_pickle(read_bytes(path, limit_bytes), path)


def parse_pickle(data: bytes, name: object = "pickle") -> dict[str, Any]:
    """Parse the bytes of a pickled dict.

    Raises the same exceptions as ``read_pickle``.
    """
    try:
        found = _interpret(data)
        if not isinstance(found, dict):
            raise PickleRefused(f"contains a {type(found).__name__}, expected a dict")
        return {key: _plain(value) for key, value in found.items()}
    except PickleRefused as error:
        raise DamagedFileError(name, f"{error}; the file was not read") from error
    except _BROKEN as error:
        words = reason_of(error, 120)
        raise DamagedFileError(name, f"not a valid pickle ({words})") from error


def _interpret(data: bytes) -> Any:
    machine = PickleMachine()
    for count, (operation, argument, _) in enumerate(pickletools.genops(data)):
        if count > MAX_OPERATIONS:
            raise PickleRefused(f"pickle with more than {MAX_OPERATIONS:,} operations")
        step: Callable[[Any], None] | None = getattr(machine, f"do_{operation.name}", None)
        if step is None:
            raise PickleRefused(f"pickle with the unsupported operation {operation.name}")
        step(argument)
    return machine.result()


def _plain(value: Any, depth: int = 0) -> Any:
    """Convert an internal value to a Python or numpy value, with at most three levels of lists."""
    if isinstance(value, ArrayValue) and value.values is not None:
        return value.values
    if value is None or isinstance(value, (bool, int, float, str, bytes, np.ndarray, np.generic)):
        return value
    if isinstance(value, (list, tuple)) and depth < 3:
        return [_plain(member, depth + 1) for member in value]
    raise PickleRefused(f"contains an unsupported {type(value).__name__}")
