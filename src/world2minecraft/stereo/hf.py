"""Any depth network that the transformers library can run, by its name or from a folder.

Nothing is downloaded unless a network is asked for by name and is not yet on this computer.
Pictures are made ready here, by what the model's own file states: the library's image processors
need torchvision, of which not every version goes with every torch.
"""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.errors import DamagedFileError, InputError, MissingExtraError
from world2minecraft.stereo.guide import Kind
from world2minecraft.types import Camera

# Models that give metres without saying so in their config. DepthPro gives inverse depth.
METRIC_TYPES = ("zoedepth", "glpn")
LARGEST_SIDE_PX = 4096
MODEL_NAME = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)?", re.ASCII)


class HuggingFaceDepth:
    """A network of a model hub or a folder, on the processor, in whole single precision.

    Raises:
        MissingExtraError: torch or transformers is not installed.
        InputError: the model cannot be had, is of another kind, or lacks weights.
    """

    kind: Kind

    def __init__(self, model: str):
        try:
            import torch  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
            import transformers  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
        except ImportError:
            raise MissingExtraError("a depth model", "hf") from None
        if not Path(model).is_dir() and not MODEL_NAME.fullmatch(model):
            raise InputError(model, "neither a folder nor the name of a model, ORG/NAME")
        self.name = f"hf:{Path(model).resolve().name if Path(model).is_dir() else model}"
        self._torch = torch
        transformers.utils.logging.disable_progress_bar()
        self._ready = _preparation(model, transformers)
        self._network = _network(model, transformers)
        config = self._network.config
        states_metres = getattr(config, "depth_estimation_type", None) == "metric"
        metric = states_metres or config.model_type in METRIC_TYPES
        self.kind = "metric" if metric else "inverse"

    def predict(self, colour: np.ndarray, camera: Camera) -> np.ndarray:
        """Return float32 [H, W] for a picture uint8 [H, W, 3]; its camera is not needed.

        One thread works: how many there are would show in the last digits.

        Raises:
            InputError: the network cannot work on a picture of this size.
        """
        torch = self._torch
        threads = torch.get_num_threads()
        torch.set_num_threads(1)
        try:
            with torch.inference_mode():
                pixels = torch.from_numpy(prepared(colour, self._ready))
                found = self._network(pixel_values=pixels).predicted_depth
        except RuntimeError as error:
            raise InputError(self.name, f"the network fails: {_first_line(error)}") from None
        finally:
            torch.set_num_threads(threads)
        values = found.reshape(found.shape[-2:]).to(torch.float32).numpy()
        size = (colour.shape[1], colour.shape[0])
        return np.array(Image.fromarray(values).resize(size, Image.Resampling.BILINEAR))


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
    size = size if isinstance(size, dict) else {"width": size, "height": size}
    if "shortest_edge" in size:
        scales = [size["shortest_edge"] / min(size_px)] * 2
    else:
        scales = [size["width"] / size_px[0], size["height"] / size_px[1]]
        if ready.get("keep_aspect_ratio"):
            scales = [min(scales, key=lambda scale: abs(1 - scale))] * 2
    wide, high = (
        max(step, round(side * scale / step) * step)
        for side, scale in zip(size_px, scales, strict=True)
    )
    return min(wide, LARGEST_SIDE_PX // step * step), min(high, LARGEST_SIDE_PX // step * step)


def _preparation(model: str, transformers) -> dict[str, Any]:
    """Return what the model states of its pictures."""
    for file in ("preprocessor_config.json", "processor_config.json"):
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
            raise DamagedFileError(model, f"{file} makes no sense: {_first_line(error)}") from None
    raise InputError(model, "no such model here or on the hub (it needs preprocessor_config.json)")


def _network(model: str, transformers):
    """Return the network, ready to run. Only safetensors are read: pickles can run programs."""
    try:
        network, told = transformers.AutoModelForDepthEstimation.from_pretrained(
            model, dtype="float32", use_safetensors=True, output_loading_info=True
        )
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {_first_line(error)}") from None
    if told["missing_keys"] or told["mismatched_keys"]:
        lacking = sorted(map(str, told["missing_keys"] or told["mismatched_keys"]))[0]
        raise DamagedFileError(model, f"its weights lack {lacking}, and would be drawn by chance")
    return network.eval()


def _first_line(error: Exception) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0]
