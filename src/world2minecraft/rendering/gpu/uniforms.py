"""The uniforms of the shader: the light, the image size and each pose.

``SCALARS`` lists the members of the uniform, from which both the shader's struct and its bytes are
generated. Camera positions are split into a cell and an offset within it, so that 32 bits are
sufficiently precise anywhere.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.rendering.light.pixel_light import LightCoefficients
from world2minecraft.rendering.light.sky import Background
from world2minecraft.rendering.light.tone_mapping import ENCODE_STEPS
from world2minecraft.rendering.ray_caster.shading import ShadingParameters
from world2minecraft.rendering.scene import BlockScene

MAX_COORDINATE = 2.0**30  # Blocks; farther cameras see nothing.
MAX_SHOULDER = 1e30
_KINDS = {"i32": np.int32, "u32": np.uint32, "f32": np.float32}
_PAPER = tuple(f"paper_{end}_{channel}" for end in ("first", "last") for channel in "rgb")
SCALARS: tuple[tuple[str, str], ...] = (
    *((name, "i32") for name in ("size_x", "size_y", "size_z", "first_x", "first_y", "first_z")),
    *((name, "i32") for name in ("window_y", "window_z", "side_px")),
    *((name, "i32") for name in ("plane_thing", "plane_opaque", "plane_normal", "plane_label")),
    *((name, "u32") for name in ("width", "height", "samples", "band_rows", "planes")),
    *((name, "u32") for name in ("plane_words", "wants_colour", "by_row", "most_steps")),
    *((name, "u32") for name in ("at_bounds", "at_starts", "at_refs", "at_elements", "at_turns")),
    *((name, "u32") for name in ("at_things", "texel_count")),
    *((name, "f32") for name in ("fx", "fy", "cx", "cy", "spread", "shoulder", *_PAPER)),
    *((f"lit_{name}", "f32") for name in LightCoefficients._fields),
    *((f"sky_{name}", "f32") for name in Background._fields),
)
_PARAMETERS = np.dtype([(name, _KINDS[kind]) for name, kind in SCALARS])
PARAMETER_BYTES = _PARAMETERS.itemsize + -_PARAMETERS.itemsize % 16
# Words of the light's tables: of a texel's channel, of the screen, of the lattice's entries.
AT_ENCODE = 256
AT_CORNERS = AT_ENCODE + ENCODE_STEPS // 4
TONE_BYTES = 4 * (AT_CORNERS + 3 * 2**14)
VIEW = np.dtype(
    [("rows", "f4", (3, 4)), ("base", "i4", 3), ("first_row", "i4"), ("ahead", "f4"), ("", "f4", 3)]
)


@dataclass(frozen=True)
class PlaneLayout:
    """The assignment of outputs to 32-bit planes; -1 for outputs without a plane.

    The first four planes are depth, range, index, and colour with the face in its highest byte.
    """

    colour: bool
    opaque: int
    normal: int
    thing: int
    label: int
    planes: int


def plane_layout(outputs: Sequence[str], has_things: bool) -> PlaneLayout:
    """Return the plane layout for a set of outputs."""
    planes = 4
    thing = planes if has_things else -1
    planes += has_things
    has_labels = "semantic" in outputs or "instance" in outputs
    label = planes if has_labels else -1
    planes += has_labels
    opaque = planes if "opaque" in outputs else -1
    planes += 3 * ("opaque" in outputs)
    normal = planes if "normal" in outputs else -1
    planes += 3 * ("normal" in outputs)
    return PlaneLayout("colour" in outputs, opaque, normal, thing, label, planes)


@dataclass(frozen=True)
class PictureRequest:
    """The properties shared by all images of a call: H x W pixels, intrinsics and light."""

    size: tuple[int, int]
    rays: tuple[float, float, float, float]  # fx, fy, cx, cy in pixels, or pixels a metre
    spread: float  # 1 for a pinhole camera, 0 for parallel rays
    samples: int
    layout: PlaneLayout


def struct_text() -> str:
    """Return the WGSL struct of the parameters."""
    members = "".join(f"  {name}: {kind},\n" for name, kind in SCALARS)
    return f"struct Params {{\n{members}}}\n"


def parameter_bytes(
    ask: PictureRequest,
    shading: ShadingParameters,
    scene: BlockScene,
    offsets: Mapping[str, int],
    band_rows: int,
) -> bytes:
    """Return the bytes of the uniform, padded to a multiple of 16.

    Args:
        ask: Properties of the images.
        shading: Light parameters.
        scene: The scene.
        offsets: Offsets of the tables in the packed scene.
        band_rows: Number of rows per view.
    """
    tables, tone, layout = scene.tables, shading.tone, ask.layout
    values: dict[str, float] = dict(offsets)
    for name, (x, y, z) in (("size", tables.space.shape), ("first", tables.window[0])):
        values |= {f"{name}_x": x, f"{name}_y": y, f"{name}_z": z}
    values |= {"window_y": tables.window[1][1], "window_z": tables.window[1][2]}
    values |= {"side_px": scene.side_px, "texel_count": tables.texels.shape[1]}
    values |= {"plane_thing": layout.thing, "plane_opaque": layout.opaque}
    values |= {"plane_normal": layout.normal, "planes": layout.planes}
    values |= {"plane_label": layout.label, "at_things": len(tables.semantic)}
    values |= {"height": ask.size[0], "width": ask.size[1], "samples": ask.samples}
    values |= {"band_rows": band_rows, "plane_words": band_rows * ask.size[1]}
    values |= {"wants_colour": layout.colour, "by_row": shading.by_row}
    values |= {"most_steps": 2 * sum(tables.space.shape) + 8}
    values |= dict(zip(("fx", "fy", "cx", "cy"), ask.rays, strict=True))
    values |= {"spread": ask.spread, "shoulder": min(tone.shoulder, MAX_SHOULDER)}
    values |= dict(zip(_PAPER, shading.paper.ravel().tolist(), strict=True))
    values |= {f"lit_{name}": value for name, value in shading.lit._asdict().items()}
    values |= {f"sky_{name}": value for name, value in shading.background._asdict().items()}
    record = np.zeros((), _PARAMETERS)
    for name, _ in SCALARS:
        record[name] = values[name]
    return record.tobytes().ljust(PARAMETER_BYTES, b"\0")


def tone_words(shading: ShadingParameters) -> np.ndarray:
    """Return the light tables as uint32: floats, four screen values per word, floats."""
    decode = np.ascontiguousarray(shading.tone.decode, np.float32).view(np.uint32)
    encode = np.ascontiguousarray(shading.tone.encode).view(np.uint32)
    return np.concatenate([decode, encode, shading.corners.view(np.uint32).ravel()])


def check_pose(pose: np.ndarray) -> None:
    """Check that a pose contains only finite numbers.

    Raises:
        ValueError: If a number is NaN or infinite.
    """
    if not np.isfinite(pose).all():
        raise ValueError("camera_to_room must contain only finite numbers")


def view_of(pose: np.ndarray, first_row: int, ahead: float = 0.0) -> np.ndarray:
    """Return a pose in the form that the shader reads, a ``VIEW`` value.

    Args:
        pose: Camera to grid transform, float64 [3, 4].
        first_row: Row of the image at which the view starts.
        ahead: Distance in metres along the camera's z axis at which rays start; see
            ``entry_distance``.
    """
    record = np.zeros((), VIEW)
    eye = np.clip(pose[:, 3] + ahead * pose[:, 2], -MAX_COORDINATE, MAX_COORDINATE)
    base = np.floor(eye)
    record["rows"] = np.concatenate([pose[:, :3], (eye - base)[:, None]], axis=1)
    record["base"] = base
    record["first_row"], record["ahead"] = first_row, ahead
    return record


def entry_distance(pose: np.ndarray, shape: tuple[int, ...]) -> float:
    """Return the distance in metres that parallel rays can skip before entering the grid.

    The rays share one direction, so a distant camera can be moved closer, where 32-bit numbers are
    more precise.

    Args:
        pose: Camera to grid transform, float64 [3, 4].
        shape: Size of the grid in cells.
    """
    corners = np.stack(np.meshgrid(*([0, size] for size in shape), indexing="ij"), axis=-1)
    ways = (corners.reshape(-1, 3) - pose[:, 3]) @ pose[:, 2] / max(pose[:, 2] @ pose[:, 2], 1e-12)
    return max(float(ways.min()) - 1.0, 0.0)
