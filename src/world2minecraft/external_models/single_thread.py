"""Torch on one thread: how many there are would show in the last digits."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def single_thread() -> Iterator[Any]:
    """Give the torch library for inference on one thread; as many as before work afterwards."""
    import torch  # noqa: PLC0415  # pyright: ignore[reportMissingImports]

    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with torch.inference_mode():
            yield torch
    finally:
        torch.set_num_threads(threads)
