"""Networks in ONNX files, run on the processor."""

from typing import Any

from world2minecraft.core.errors import DamagedFileError, first_line


def session_options(threads: int = 1) -> Any:
    """Return options of a session that prints no warnings."""
    import onnxruntime  # noqa: PLC0415  # Half a second that most commands do not need.

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.inter_op_num_threads = 1
    options.log_severity_level = 3
    return options


def open_session(path: object, data: bytes, options: Any) -> Any:
    """Return an ``onnxruntime.InferenceSession`` of a network.

    Args:
        path: The file of the network, for messages.
        data: The contents of the file.
        options: Options of the session, from ``session_options``.

    Raises:
        DamagedFileError: If the file is not a valid network.
    """
    import onnxruntime  # noqa: PLC0415

    try:
        return onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    except Exception as error:  # onnxruntime has no exception tree of its own.
        raise DamagedFileError(path, f"is not a valid ONNX file: {first_line(error)}") from error
