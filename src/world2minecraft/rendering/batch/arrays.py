"""The arrays of a batch, and the kernel that renders the images of many poses into them.

``BatchArrays`` is the user's view, ``BatchPixels`` is the same memory as the kernel reads it.
Arrays are allocated once and reused.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.picture import MAX_PIXELS, MAX_SAMPLES, Picture
from world2minecraft.rendering.picture_arrays import OUTPUT_BITS, PixelArrays
from world2minecraft.rendering.ray_caster.picture_kernel import draw_rows
from world2minecraft.rendering.ray_caster.ray import GridCamera

MAX_BYTES = 1 << 36  # 64 GiB; a larger batch is probably a mistake.
MAX_PICTURES = 1_000_000
EMPTY = np.empty(0)
Size = tuple[int, int]  # height, width
# Array: (output, name in the kernel, dtype, trailing shape).
_PLAN = {
    "depth_m": ("depth", "depth", np.float32, ()),
    "range_m": ("range", "distance", np.float32, ()),
    "block_index": ("block", "block", np.int32, ()),
    "face": ("face", "face", np.uint8, ()),
    "cube_index": ("cube", "thing", np.int32, ()),
    "colour": ("colour", "colour", np.uint8, (3,)),
    "semantic": ("semantic", "semantic", np.uint8, ()),
    "instance": ("instance", "instance", np.uint16, ()),
    "opaque_depth_m": ("opaque", "opaque_depth", np.float32, ()),
    "opaque_index": ("opaque", "opaque_index", np.int32, ()),
    "opaque_cube_index": ("opaque", "opaque_thing", np.int32, ()),
    "normal": ("normal", "normal", np.float32, (3,)),
}
_ALWAYS = ("depth", "distance", "block", "face", "thing")  # The kernel always writes these.
BATCH_OUTPUTS = (*dict.fromkeys(output for output, *_ in _PLAN.values()), "free")
# Outputs that ``render_volume`` always renders.
PICTURE_OUTPUTS = ("depth", "range", "block", "face", "cube")
ArraySpec = tuple[tuple[int, ...], np.dtype]


class BatchPixels(NamedTuple):
    """``PixelArrays`` with a leading axis for N images.

    An array that the kernel needs but the user did not request holds one image per thread, which
    each image of that thread overwrites.
    """

    depth: np.ndarray  # float32 [N, H, W]
    distance: np.ndarray  # float32 [N, H, W]
    block: np.ndarray  # int32 [N, H, W]
    face: np.ndarray  # uint8 [N, H, W]
    thing: np.ndarray  # int32 [N, H, W]
    opaque_depth: np.ndarray  # float32 [N, H, W]
    opaque_index: np.ndarray  # int32 [N, H, W]
    opaque_thing: np.ndarray  # int32 [N, H, W]
    normal: np.ndarray  # float32 [N, H, W, 3]
    semantic: np.ndarray  # uint8 [N, H, W]
    instance: np.ndarray  # uint16 [N, H, W]
    colour: np.ndarray  # uint8 [N, H, W, 3]
    wanted: int


class BatchPart(NamedTuple):
    """The rows and images that one thread renders."""

    start: int  # index of the first image
    stride: int  # step to the next image
    first: int  # first row, a multiple of the tile height
    last: int  # last row + 1
    slot: int  # index of the thread in arrays with one image per thread


@lean
def draw_poses(tables, side_px, poses, rays, part, shading, memory, out):
    """Render every ``part.stride``-th image, in the rows of ``part``, with a pinhole camera.

    Args:
        tables: ``SceneTables`` with textures of ``side_px``.
        side_px: Texture size in pixels.
        poses: Camera-to-grid transforms of all N images, float64 [N, 3, 4].
        rays: Ray parameters of all N images, float64 [N, 4]; see ``GridCamera``.
        part: ``BatchPart`` with the images and rows to render.
        shading: ``ShadingParameters``.
        memory: ``BandMemory`` of the calling thread.
        out: ``BatchPixels``, which receives the images.
    """
    count, slot = len(poses), part.slot
    for n in range(part.start, count, part.stride):
        picture = PixelArrays(
            out.depth[picture_row(out.depth, n, slot, count)],
            out.distance[picture_row(out.distance, n, slot, count)],
            out.block[picture_row(out.block, n, slot, count)],
            out.face[picture_row(out.face, n, slot, count)],
            out.thing[picture_row(out.thing, n, slot, count)],
            out.opaque_depth[picture_row(out.opaque_depth, n, slot, count)],
            out.opaque_index[picture_row(out.opaque_index, n, slot, count)],
            out.opaque_thing[picture_row(out.opaque_thing, n, slot, count)],
            out.normal[picture_row(out.normal, n, slot, count)],
            out.semantic[picture_row(out.semantic, n, slot, count)],
            out.instance[picture_row(out.instance, n, slot, count)],
            out.colour[picture_row(out.colour, n, slot, count)],
            out.wanted,
        )
        camera = GridCamera(poses[n], rays[n], 1.0)
        draw_rows(tables, side_px, camera, part.first, part.last, shading, memory, picture)


@inlined
def picture_row(array, n, slot, count):
    """Return the index of image ``n`` in an array of ``count`` images or of one per thread."""
    return n if len(array) == count else min(slot, len(array) - 1)


@dataclass(frozen=True, eq=False)
class BatchArrays:
    """The outputs of N images. Outputs that were not requested are None.

    Each array is described in ``Picture`` and has an additional leading axis for the images.
    """

    depth_m: np.ndarray | None = None  # float32 [N, H, W], z-depth
    range_m: np.ndarray | None = None  # float32 [N, H, W], along the ray
    block_index: np.ndarray | None = None  # int32 [N, H, W]
    face: np.ndarray | None = None  # uint8 [N, H, W]
    cube_index: np.ndarray | None = None  # int32 [N, H, W]
    colour: np.ndarray | None = None  # uint8 [N, H, W, 3]
    semantic: np.ndarray | None = None  # uint8 [N, H, W]
    instance: np.ndarray | None = None  # uint16 [N, H, W]
    opaque_depth_m: np.ndarray | None = None  # float32 [N, H, W]
    opaque_index: np.ndarray | None = None  # int32 [N, H, W]
    opaque_cube_index: np.ndarray | None = None  # int32 [N, H, W]
    normal: np.ndarray | None = None  # float32 [N, H, W, 3]
    free: np.ndarray | None = None  # bool [N, X, Y, Z]

    def picture(self, number: int) -> Picture:
        """Return one image, which shares the memory of the batch.

        Arrays that every ``Picture`` has, but that were not requested, are empty.
        """
        parts = {field.name: getattr(self, field.name) for field in fields(self)}
        given = {name: array[number] for name, array in parts.items() if array is not None}
        always = dict.fromkeys(("depth_m", "range_m", "block_index", "face", "cube_index"), EMPTY)
        return Picture(**{**always, **given})

    def named(self) -> Iterator[tuple[str, np.ndarray]]:
        """Yield each existing array with its name."""
        for field in fields(self):
            if (array := getattr(self, field.name)) is not None:
                yield field.name, array


def array_specs(
    count: int, size: Size, outputs: Collection[str], shape: tuple[int, ...]
) -> dict[str, ArraySpec]:
    """Return the shape and dtype of each array of a batch, by name.

    Args:
        count: Number of images N.
        size: Height and width in pixels.
        outputs: Outputs from ``BATCH_OUTPUTS``.
        shape: Size of the volume, X, Y and Z.

    Raises:
        UsageError: If an output is unknown, or if the batch needs too much memory.
    """
    unknown = sorted(set(outputs) - set(BATCH_OUTPUTS))
    if unknown:
        raise UsageError(f"unknown output {unknown[0]!r}; outputs: {', '.join(BATCH_OUTPUTS)}")
    rooms: dict[str, ArraySpec] = {
        name: ((count, *size, *rest), np.dtype(kind))
        for name, (output, _, kind, rest) in _PLAN.items()
        if output in outputs
    }
    if "free" in outputs:
        rooms["free"] = ((count, *shape), np.dtype(bool))
    total = total_bytes(rooms)
    if total > MAX_BYTES:
        raise UsageError(
            f"{count:,} images of {size[1]}x{size[0]} need {total / 2**30:,.0f} GiB; use fewer "
            "poses per batch, or render_stream, which only keeps a few images in memory"
        )
    return rooms


def total_bytes(rooms: dict[str, ArraySpec]) -> int:
    """Return the total size of all arrays in bytes."""
    return sum(int(np.prod(shape, dtype=object)) * kind.itemsize for shape, kind in rooms.values())


def batch_arrays(
    count: int, size: Size, outputs: Collection[str], shape: tuple[int, ...] = (0, 0, 0)
) -> BatchArrays:
    """Return zero-filled arrays for ``render_batch``. See ``array_specs`` for the arguments."""
    rooms = array_specs(count, size, outputs, shape)
    return BatchArrays(**{name: np.zeros(*room) for name, room in rooms.items()})


def check_batch(count: int, size: Size, samples: int) -> None:
    """Check the arguments of a batch.

    Raises:
        UsageError: If the batch cannot be rendered.
    """
    if count > MAX_PICTURES:
        raise UsageError(f"a batch may have at most {MAX_PICTURES:,} poses, got {count:,}")
    if not 1 <= samples <= MAX_SAMPLES:
        raise UsageError(f"samples must be 1 to {MAX_SAMPLES}, got {samples}")
    if size[0] * size[1] * samples**2 > MAX_PIXELS:
        raise UsageError(
            f"an image may have at most {MAX_PIXELS:,} samples, got {size[1]}x{size[0]}"
        )


def check_arrays(given: BatchArrays, rooms: dict[str, ArraySpec]) -> None:
    """Check that arrays match a batch.

    Raises:
        UsageError: If an array is missing, superfluous or of the wrong shape or dtype.
    """
    arrays = dict(given.named())
    for name, (shape, kind) in rooms.items():
        array = arrays.pop(name, None)
        given_text = "nothing" if array is None else f"{array.dtype} {list(array.shape)}"
        if array is None or array.shape != shape or array.dtype != kind:
            raise UsageError(f"out.{name} must be {kind} {list(shape)}, got {given_text}")
        if not (array.flags.c_contiguous and array.flags.writeable):
            raise UsageError(f"out.{name} must be C-contiguous and writable")
    if arrays:
        raise UsageError(f"out.{min(arrays)} is given but not requested in outputs")


def kernel_arrays(
    arrays: BatchArrays, size: Size, slots: int, outputs: Collection[str], *, fine: bool
) -> BatchPixels:
    """Return the arrays for the kernel, with scratch memory for outputs that were not requested.

    Args:
        arrays: Arrays of the batch.
        size: Height and width in pixels.
        slots: Maximum number of threads.
        outputs: Requested outputs.
        fine: Whether the colour is rendered separately.
    """
    wanted = sum(bit for name, bit in OUTPUT_BITS.items() if name in outputs)
    parts = {}
    for name, (_, kernel_name, kind, rest) in _PLAN.items():
        array = getattr(arrays, name)
        if array is None:
            room = (slots, *size) if kernel_name in _ALWAYS else (1, 1, 1)
            array = np.zeros((*room, *rest), kind)
        parts[kernel_name] = array
    if fine:
        wanted &= ~OUTPUT_BITS["colour"]
    return BatchPixels(**parts, wanted=wanted)
