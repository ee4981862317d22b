"""Writing of OpenEXR files with 32-bit floats: single-part scan lines, ZIP or no compression."""

import io
from collections.abc import Mapping

import numpy as np


def exr_bytes(
    channels: Mapping[str, np.ndarray],
    *,
    compress: bool = True,
    notes: Mapping[str, str] | None = None,
) -> bytes:
    """Encode float32 channels as an EXR file.

    Args:
        channels: Channels by name, float32 [H, W], all of the same size. Depth is named ``Z``.
        compress: Whether to compress the scan lines with deflate.
        notes: Text attributes for the header.

    Raises:
        ValueError: If there are no channels, or if their sizes differ.
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
