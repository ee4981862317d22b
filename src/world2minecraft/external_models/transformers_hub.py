"""Networks of the transformers library, by the name on the hub or from a folder.

Nothing is downloaded unless a network is asked for by name and is not yet on this computer. Only
safetensors are read, and no code that comes with a model is run.
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

# Torch on one thread: how many there are would show in the last digits.


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


# Pictures as networks want them, by what a model's own preprocessor file states.
#
# The image processors of the transformers library need torchvision, of which not every version goes
# with every torch; the few steps that they take are here.

LARGEST_SIDE_PX = 4096


def prepared(colour: np.ndarray, ready: dict[str, Any]) -> np.ndarray:
    """Return a picture as a network wants it.

    Args:
        colour: uint8 [H, W, 3].
        ready: the entries of a preprocessor_config.json.

    Returns:
        float32 [1, 3, h, w].
    """
    picture = Image.fromarray(colour)
    if ready.get("do_resize", True):
        picture = picture.resize(
            wanted_size(picture.size, ready), Image.Resampling(ready.get("resample", 3))
        )
    values = np.asarray(picture, np.float32)
    if ready.get("do_rescale", True):
        values = values * np.float32(ready.get("rescale_factor", 1 / 255))
    if ready.get("do_normalize", "image_mean" in ready):
        mean, spread = (np.array(ready[key], np.float32) for key in ("image_mean", "image_std"))
        values = (values - mean) / spread
    return np.ascontiguousarray(values.transpose(2, 0, 1)[None])


def wanted_size(size_px: tuple[int, int], ready: dict[str, Any]) -> tuple[int, int]:
    """Return the width and height that a network wants of a picture of a width and height.

    >>> wanted_size((640, 480), {"size": 518, "keep_aspect_ratio": True, "ensure_multiple_of": 14})
    (686, 518)
    """
    step = ready.get("ensure_multiple_of") or ready.get("size_divisor") or 1
    size = ready.get("size") or {"width": size_px[0], "height": size_px[1]}
    if not isinstance(size, dict):
        square = "max_size" not in ready  # Older files of segmenters mean the shorter side.
        size = {"width": size, "height": size} if square else {"shortest_edge": size}
    longest = size.get("longest_edge") or ready.get("max_size") or LARGEST_SIDE_PX
    if "shortest_edge" in size:
        scales = [min(size["shortest_edge"] / min(size_px), longest / max(size_px))] * 2
    else:
        scales = [size["width"] / size_px[0], size["height"] / size_px[1]]
        if ready.get("keep_aspect_ratio"):
            scales = [min(scales, key=lambda scale: abs(1 - scale))] * 2
    wide, high = (
        max(step, round(side * scale / step) * step)
        for side, scale in zip(size_px, scales, strict=True)
    )
    return min(wide, LARGEST_SIDE_PX // step * step), min(high, LARGEST_SIDE_PX // step * step)


MODEL_NAME = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)?", re.ASCII)
READY_FILES = ("preprocessor_config.json", "processor_config.json")
SHORT = 16  # Digits of a digest that tell two models apart.


def library(feature: str) -> Any:
    """Return the transformers library, silent.

    Raises:
        MissingExtraError: torch or transformers is not installed; ``feature`` is what needs them.
    """
    try:
        import torch  # noqa: F401, PLC0415  # pyright: ignore[reportMissingImports]
        import transformers  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError(feature, "hf") from None
    transformers.utils.logging.disable_progress_bar()
    return transformers


def checked_name(model: str) -> str:
    """Return what reports call a model.

    Raises:
        InputError: it is neither a folder nor could be the name of a model.
    """
    folder = Path(model).is_dir()
    if not folder and not MODEL_NAME.fullmatch(model):
        raise InputError(model, "neither a folder nor the name of a model, ORG/NAME")
    return f"hf:{Path(model).resolve().name if folder else model}"


def identity(model: str, transformers: Any) -> str:
    """Return what tells this state of a model from any other: a digest or the hub's commit.

    Raises:
        InputError: there is no such model.
    """
    if Path(model).is_dir():
        digest = hashlib.sha256()
        for path in sorted(Path(model).glob("*")):
            if path.suffix in (".json", ".safetensors", ".txt"):
                digest.update(path.name.encode() + b"\0")
                with path.open("rb") as stream:
                    digest.update(hashlib.file_digest(stream, "sha256").digest())
        return digest.hexdigest()[:SHORT]
    try:
        path = Path(transformers.utils.cached_file(model, "config.json"))
    except (OSError, ValueError):
        raise InputError(model, "no such model here or on the hub") from None
    return f"{model}@{path.parent.name[:SHORT]}"


def config(model: str, transformers: Any) -> Any:
    """Return the config of a model.

    Raises:
        InputError: there is no such model, or its config cannot be read.
    """
    try:
        return transformers.AutoConfig.from_pretrained(model)
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None


def has_file(model: str, names: tuple[str, ...], transformers: Any) -> bool:
    """Return whether a model comes with one of some files."""
    for name in names:
        try:
            transformers.utils.cached_file(model, name)
        except (OSError, ValueError):
            continue
        return True
    return False


def preparation(model: str, transformers: Any) -> dict[str, Any]:
    """Return what a model states of its pictures.

    Raises:
        DamagedFileError: what it states makes no sense. InputError: there is no such model.
    """
    for file in READY_FILES:
        try:
            path = transformers.utils.cached_file(model, file)
        except (OSError, ValueError):
            continue
        try:
            stated = json.loads(Path(path).read_text(encoding="utf-8"))
            ready = stated.get("image_processor", stated)
            prepared(np.zeros((30, 40, 3), np.uint8), ready)
            return ready
        except (AttributeError, KeyError, TypeError, ValueError, ArithmeticError) as error:
            raise DamagedFileError(model, f"{file} makes no sense: {first_line(error)}") from None
    raise InputError(model, "no such model here or on the hub (it needs preprocessor_config.json)")


def network(model: str, kind: Any) -> Any:
    """Return a network, ready to run, in whole single precision.

    Args:
        model: a name or a folder.
        kind: the class of the library that loads it, such as ``AutoModelForDepthEstimation``.

    Raises:
        InputError: it cannot be had or is of another kind. DamagedFileError: weights are lacking.
    """
    try:
        found, told = kind.from_pretrained(
            model, dtype="float32", use_safetensors=True, output_loading_info=True
        )
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None
    if told["missing_keys"] or told["mismatched_keys"]:
        lacking = sorted(map(str, told["missing_keys"] or told["mismatched_keys"]))[0]
        raise DamagedFileError(model, f"its weights lack {lacking}, and would be drawn by chance")
    return found.eval()
