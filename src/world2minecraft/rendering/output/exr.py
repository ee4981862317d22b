"""OpenEXR files of 32-bit floats: single-part scanlines, zip or no compression."""

import io
from collections.abc import Mapping

import numpy as np


def exr_bytes(
    channels: Mapping[str, np.ndarray],
    *,
    compress: bool = True,
    notes: Mapping[str, str] | None = None,
) -> bytes:
    """Return an EXR file of float32 channels.

    Args:
        channels: name to float32 [H, W], all of one size; depth is called ``Z``.
        compress: deflate, or raw lines.
        notes: text attributes for the header.

    Raises:
        ValueError: there is no channel, or their sizes differ.
    """
    import OpenEXR  # noqa: PLC0415  # Only a few pictures are EXR.

    arrays = {name: np.ascontiguousarray(one, np.float32) for name, one in channels.items()}
    sizes = {one.shape for one in arrays.values()}
    if len(sizes) != 1 or len(sizes.pop()) != 2:
        raise ValueError("EXR channels must be float32 arrays [H, W] of the same size")
    header = {
        **(notes or {}),
        "type": OpenEXR.scanlineimage,
        "compression": OpenEXR.ZIP_COMPRESSION if compress else OpenEXR.NO_COMPRESSION,
    }
    stream = io.BytesIO()
    OpenEXR.File(header, arrays, num_threads=0).write(stream)
    return stream.getvalue()
