"""Networks of the transformers library, by their name on the Hugging Face Hub or from a folder.

A network is only downloaded if it is requested by name and is not cached yet. Only safetensors are
loaded, and no code from a model repository is executed. Images are preprocessed here according to
the model's preprocessor file, because the library's image processors require torchvision, which is
not compatible with every version of torch. Inference uses one thread, because the number of threads
affects the last digits of the result.
"""

import hashlib
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, InputError, MissingExtraError, first_line

MAX_SIDE_PX = 4096
MODEL_NAME = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)?", re.ASCII)
PREPROCESSOR_FILES = ("preprocessor_config.json", "processor_config.json")
DIGEST_DIGITS = 16  # Digits of a digest that tell two models apart.


@contextmanager
def single_thread() -> Iterator[Any]:
    """Yield the torch library for inference on one thread, and reset the threads afterwards."""
    import torch  # noqa: PLC0415  # pyright: ignore[reportMissingImports]

    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with torch.inference_mode():
            yield torch
    finally:
        torch.set_num_threads(threads)


def preprocess(colour: np.ndarray, settings: dict[str, Any]) -> np.ndarray:
    """Preprocess an image for a network.

    Args:
        colour: The image as uint8 [H, W, 3].
        settings: The entries of a preprocessor_config.json.

    Returns:
        The input of the network as float32 [1, 3, h, w].
    """
    picture = Image.fromarray(colour)
    if settings.get("do_resize", True):
        picture = picture.resize(
            preprocessed_size(picture.size, settings), Image.Resampling(settings.get("resample", 3))
        )
    values = np.asarray(picture, np.float32)
    if settings.get("do_rescale", True):
        values = values * np.float32(settings.get("rescale_factor", 1 / 255))
    if settings.get("do_normalize", "image_mean" in settings):
        mean, spread = (np.array(settings[key], np.float32) for key in ("image_mean", "image_std"))
        values = (values - mean) / spread
    return np.ascontiguousarray(values.transpose(2, 0, 1)[None])


def preprocessed_size(size_px: tuple[int, int], settings: dict[str, Any]) -> tuple[int, int]:
    """Return the width and height to which an image is resized for a network.

    Example:
        >>> settings = {"size": 518, "keep_aspect_ratio": True, "ensure_multiple_of": 14}
        >>> preprocessed_size((640, 480), settings)
        (686, 518)
    """
    step = settings.get("ensure_multiple_of") or settings.get("size_divisor") or 1
    size = settings.get("size") or {"width": size_px[0], "height": size_px[1]}
    if not isinstance(size, dict):
        square = "max_size" not in settings  # Older files of segmenters mean the shorter side.
        size = {"width": size, "height": size} if square else {"shortest_edge": size}
    longest = size.get("longest_edge") or settings.get("max_size") or MAX_SIDE_PX
    if "shortest_edge" in size:
        scales = [min(size["shortest_edge"] / min(size_px), longest / max(size_px))] * 2
    else:
        scales = [size["width"] / size_px[0], size["height"] / size_px[1]]
        if settings.get("keep_aspect_ratio"):
            scales = [min(scales, key=lambda scale: abs(1 - scale))] * 2
    wide, high = (
        max(step, round(side * scale / step) * step)
        for side, scale in zip(size_px, scales, strict=True)
    )
    return min(wide, MAX_SIDE_PX // step * step), min(high, MAX_SIDE_PX // step * step)


def import_transformers(feature: str) -> Any:
    """Import the transformers library with progress bars disabled.

    Args:
        feature: The feature that requires it, for the error message.

    Raises:
        MissingExtraError: If torch or transformers is not installed.
    """
    try:
        import torch  # noqa: F401, PLC0415  # pyright: ignore[reportMissingImports]
        import transformers  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError(feature, "hf") from None
    transformers.utils.logging.disable_progress_bar()
    return transformers


def display_name(model: str) -> str:
    """Return the name of a model for reports.

    Raises:
        InputError: If the text is neither a folder nor a valid model name.
    """
    folder = Path(model).is_dir()
    if not folder and not MODEL_NAME.fullmatch(model):
        raise InputError(model, "neither a folder nor a model name of the form ORG/NAME")
    return f"hf:{Path(model).resolve().name if folder else model}"


def model_revision(model: str, transformers: Any) -> str:
    """Return the revision of a model: a digest of its files, or its commit on the Hub.

    Raises:
        InputError: If the model is not found.
    """
    if Path(model).is_dir():
        digest = hashlib.sha256()
        for path in sorted(Path(model).glob("*")):
            if path.suffix in (".json", ".safetensors", ".txt"):
                digest.update(path.name.encode() + b"\0")
                with path.open("rb") as stream:
                    digest.update(hashlib.file_digest(stream, "sha256").digest())
        return digest.hexdigest()[:DIGEST_DIGITS]
    try:
        path = Path(transformers.utils.cached_file(model, "config.json"))
    except (OSError, ValueError):
        raise InputError(model, "model not found locally or on the Hugging Face Hub") from None
    return f"{model}@{path.parent.name[:DIGEST_DIGITS]}"


def load_config(model: str, transformers: Any) -> Any:
    """Load the configuration of a model.

    Raises:
        InputError: If the model is not found, or its configuration cannot be read.
    """
    try:
        return transformers.AutoConfig.from_pretrained(model)
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None


def has_file(model: str, names: tuple[str, ...], transformers: Any) -> bool:
    """Return whether a model includes one of the given files."""
    for name in names:
        try:
            transformers.utils.cached_file(model, name)
        except (OSError, ValueError):
            continue
        return True
    return False


def load_preprocessor(model: str, transformers: Any) -> dict[str, Any]:
    """Load the settings of a model's preprocessor file.

    Raises:
        DamagedFileError: If the settings are invalid.
        InputError: If the model is not found.
    """
    for file in PREPROCESSOR_FILES:
        try:
            path = transformers.utils.cached_file(model, file)
        except (OSError, ValueError):
            continue
        try:
            stated = json.loads(Path(path).read_text(encoding="utf-8"))
            settings = stated.get("image_processor", stated)
            preprocess(np.zeros((30, 40, 3), np.uint8), settings)
            return settings
        except (AttributeError, KeyError, TypeError, ValueError, ArithmeticError) as error:
            raise DamagedFileError(model, f"{file} is not valid: {first_line(error)}") from None
    raise InputError(model, "preprocessor_config.json not found locally or on the Hugging Face Hub")


def load_network(model: str, kind: Any) -> Any:
    """Load a network in single precision for inference.

    Args:
        model: A model name or a folder.
        kind: The transformers class that loads it, such as ``AutoModelForDepthEstimation``.

    Raises:
        InputError: If the model cannot be loaded, or is of another kind.
        DamagedFileError: If weights are missing.
    """
    try:
        found, report = kind.from_pretrained(
            model, dtype="float32", use_safetensors=True, output_loading_info=True
        )
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None
    if report["missing_keys"] or report["mismatched_keys"]:
        lacking = sorted(map(str, report["missing_keys"] or report["mismatched_keys"]))[0]
        raise DamagedFileError(
            model,
            f"the weights lack {lacking}, which would be initialised randomly; use a complete "
            "checkpoint",
        )
    return found.eval()
