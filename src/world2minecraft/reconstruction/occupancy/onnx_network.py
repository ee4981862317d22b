"""The ONNX file of a monocular occupancy network, validated before it is run.

The network gets an image with its camera and the pose of the grid relative to that camera, and
returns the probabilities of the 12 classes. The format is described in
docs/reference/onnx-networks.md.
``METADATA`` lists the entries that a file must contain, so that shapes, frames and class order are
explicit.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES
from world2minecraft.core.errors import DamagedFileError, first_line
from world2minecraft.core.onnx_sessions import open_session, session_options
from world2minecraft.core.shipped_weights import read_weights
from world2minecraft.geometry.view_region import REGION_KINDS

CONTRACT = "occupancy-1"
INPUTS = {"image": (1, 3, 0, 0), "intrinsics": (1, 3, 3), "camera_to_grid": (1, 4, 4)}
DEPTH = {"depth_m": (1, 0, 0)}  # The one input that a network may do without.
OUTPUT = "logits"  # float32 [1, 12, X, Y, Z]
PREFIX = "w2m_"
MAX_BYTES = 1 << 30
MAX_CELLS = 4_000_000


@dataclass(frozen=True)
class NetworkFacts:
    """The metadata of a network file.

    Attributes:
        name: Name of the network.
        grid_shape: Number of cells along each axis.
        voxel_m: Cell size in metres.
        image_size_px: Width and height of the input image.
        wants_depth: Whether the network has a depth input.
        region: Kind of the box it was trained on.
        temperature: Divisor of the logits that calibrates them.
    """

    name: str
    grid_shape: tuple[int, int, int]
    voxel_m: float
    image_size_px: tuple[int, int]
    wants_depth: bool = False
    region: str = "paper"
    temperature: float = 1.0

    def metadata(self) -> dict[str, str]:
        """Return the metadata to write to the file, without the image size.

        The image size is given by the shapes of the network inputs.
        """
        values = {
            "contract": CONTRACT,
            "name": self.name,
            "classes": ",".join(CLASS_NAMES),
            "grid_shape": ",".join(map(str, self.grid_shape)),
            "voxel_m": repr(float(self.voxel_m)),
            "region": self.region,
            "temperature": repr(float(self.temperature)),
        }
        return {PREFIX + key: value for key, value in values.items()}


class OccupancyNetwork:
    """An occupancy network that runs on one CPU thread, with identical bits on every run.

    ``digest`` is the SHA-256 of the file.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file violates the format.
    """

    def __init__(self, path: str | Path):
        data = read_weights(path, MAX_BYTES)
        self.digest = hashlib.sha256(data).hexdigest()
        options = session_options()
        # Weights stored as bytes become floats once, as the file is loaded; and what a file does in
        # bytes is done in floats, since byte kernels round otherwise on other processors.
        options.add_session_config_entry("session.disable_quant_qdq", "1")
        self._session = open_session(path, data, options)
        try:
            self.facts = _facts(self._session)
        except ValueError as error:
            raise DamagedFileError(
                path, f"{error}; docs/reference/onnx-networks.md describes the format"
            ) from None
        self._path = path
        self._wanted = {entry.name for entry in self._session.get_inputs()}

    def probabilities(
        self,
        image: np.ndarray,
        intrinsics: np.ndarray,
        camera_to_grid: np.ndarray,
        depth_m: np.ndarray | None = None,
    ) -> np.ndarray:
        """Predict the class probabilities of each cell, float32 [X, Y, Z, 12].

        Args:
            image: RGB image in [0, 1] at the network's size, float32 [3, H, W].
            intrinsics: Intrinsics [3, 3] of this image; pixel centres are at +0.5.
            camera_to_grid: Transform [4, 4] from the OpenCV camera to metres from the corner of
                cell (0, 0, 0).
            depth_m: Depth in metres, float32 [H, W], 0 is missing; not used by a network without
                depth input.

        Raises:
            DamagedFileError: If the network fails, or returns NaN or infinite values.
        """
        given = {"image": image, "intrinsics": intrinsics, "camera_to_grid": camera_to_grid}
        given["depth_m"] = np.zeros(image.shape[1:]) if depth_m is None else depth_m
        fed = {name: given[name].astype(np.float32)[None] for name in sorted(self._wanted)}
        try:
            logits = np.asarray(self._session.run([OUTPUT], fed)[0])[0]
        except Exception as error:
            raise DamagedFileError(
                self._path, f"cannot run the network: {first_line(error)}"
            ) from None
        if not np.isfinite(logits).all():
            raise DamagedFileError(self._path, "the network returned NaN or infinite values")
        logits = np.moveaxis(logits / np.float32(self.facts.temperature), 0, -1)
        raised = np.exp(logits - logits.max(axis=-1, keepdims=True))
        return raised / raised.sum(axis=-1, keepdims=True)


def _facts(session: Any) -> NetworkFacts:
    """Return the metadata of a file. Raises ValueError if it violates the format."""
    stated = session.get_modelmeta().custom_metadata_map
    contract = stated.get(PREFIX + "contract")
    if contract != CONTRACT:
        raise ValueError(f"expected the contract {CONTRACT!r} in the metadata, got {contract!r}")
    if stated.get(PREFIX + "classes") != ",".join(CLASS_NAMES):
        raise ValueError(f"the metadata must list the classes {', '.join(CLASS_NAMES)}")
    shape = _numbers(stated, "grid_shape")
    if len(shape) != 3 or min(shape) < 1 or any(n % 1 for n in shape) or np.prod(shape) > MAX_CELLS:
        raise ValueError(
            f"{PREFIX}grid_shape must be three positive integers of at most {MAX_CELLS:,} cells in "
            f"all, got {stated.get(PREFIX + 'grid_shape')!r}"
        )
    (voxel_m,), (temperature,) = _numbers(stated, "voxel_m"), _numbers(stated, "temperature", "1")
    region = stated.get(PREFIX + "region", "paper")
    if not (0 < voxel_m < 10 and 0 < temperature < 100) or region not in REGION_KINDS:
        raise ValueError(
            f"expected voxel_m in (0, 10), temperature in (0, 100) and a region of "
            f"{', '.join(REGION_KINDS)}, got {voxel_m:g}, {temperature:g} and {region!r}"
        )
    x, y, z = (int(n) for n in shape)
    sizes = _input_sizes(session)
    _check_output(session, (1, CLASS_COUNT, x, y, z))
    _, _, high, wide = sizes["image"]
    if sizes.get("depth_m", (1, high, wide)) != (1, high, wide):
        raise ValueError("the input 'depth_m' must have the same size as the input 'image'")
    name = stated.get(PREFIX + "name", "network")
    return NetworkFacts(
        name, (x, y, z), voxel_m, (wide, high), "depth_m" in sizes, region, temperature
    )


def _numbers(stated: Mapping[str, str], key: str, usual: str = "") -> list[float]:
    text = stated.get(PREFIX + key, usual)
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise ValueError(
            f"{PREFIX}{key} must be a number or numbers separated by commas, got {text!r}"
        ) from None


def _input_sizes(session: Any) -> dict[str, tuple[int, ...]]:
    found = {}
    for entry in session.get_inputs():
        wanted = (INPUTS | DEPTH).get(entry.name)
        if wanted is None:
            raise ValueError(
                f"unknown network input {entry.name!r}; known: {', '.join(INPUTS | DEPTH)}"
            )
        whole = all(isinstance(side, int) and side > 0 for side in entry.shape)
        fits = whole and len(entry.shape) == len(wanted)
        fits = fits and all(w in (0, s) for w, s in zip(wanted, entry.shape, strict=True))
        if not fits or entry.type != "tensor(float)":
            raise ValueError(
                f"the input {entry.name!r} must be float32 with fixed shape "
                f"{[side or 'any' for side in wanted]}, got {entry.type} {entry.shape}"
            )
        found[entry.name] = tuple(entry.shape)
    if "image" not in found:
        raise ValueError("the network has no input 'image'")
    return found


def _check_output(session: Any, wanted: tuple[int, ...]) -> None:
    shapes = {entry.name: tuple(entry.shape) for entry in session.get_outputs()}
    if shapes.get(OUTPUT) != wanted:
        raise ValueError(f"expected an output {OUTPUT!r} of shape {list(wanted)}, got {shapes}")
