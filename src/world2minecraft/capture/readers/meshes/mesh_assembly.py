"""Assembly of many mesh parts into one mesh, with colours, textures and labels."""

import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image

from world2minecraft.capture.images import MAX_PIXELS
from world2minecraft.capture.readers.meshes.mesh_and_cloud import (
    MAX_FACES,
    MAX_VERTICES,
    Mesh,
    are_places,
)
from world2minecraft.capture.readers.meshes.mesh_rasterizer import GREY
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError

# Of all pictures; larger ones are shrunk: 2 mm of a room in 144 MB.
MAX_TEXTURE_PIXELS = 48_000_000
TEXTURE_TOO_LARGE = "contains a texture image of more than 64 megapixels; reduce its size"


@dataclass(frozen=True, eq=False)
class MeshPart:
    """One mesh of a scene, in the frame of the scene.

    Attributes:
        vertices: Vertex positions, float64 [V, 3].
        faces: Vertex indices of the triangles, int [F, 3].
        colour: sRGB colours of the vertices, uint8 [V, 3], or None.
        picture: Texture image, or None.
        uv: Texture coordinates, float [V, 2] with (0, 0) at the upper left corner, or None.
        tint: RGB factor from 0 to 255 by which the texture is multiplied.
        label: Class id of all triangles, or uint8 [F] with one class id per triangle.
    """

    vertices: np.ndarray
    faces: np.ndarray
    colour: np.ndarray | None = None
    picture: Image.Image | None = None
    uv: np.ndarray | None = None
    tint: tuple[int, int, int] = (255, 255, 255)
    label: int | np.ndarray = 255


def check_sizes(path: AnyPath, vertices: int, faces: int) -> None:
    """Check that a mesh is small enough to be read.

    Raises:
        LimitError: If the mesh has too many vertices or triangles.
    """
    for name, count, maximum in (
        ("vertices", vertices, MAX_VERTICES),
        ("triangles", faces, MAX_FACES),
    ):
        if count > maximum:
            raise LimitError(
                path, f"contains {count:,} {name}, the limit is {maximum:,}; export a coarser mesh"
            )


def open_texture(path: AnyPath, data: bytes) -> Image.Image | None:
    """Open a texture image, whose pixels are decoded later, or return None if it is not an image.

    Raises:
        LimitError: If the image is so large that Pillow refuses it.
    """
    try:
        with warnings.catch_warnings(category=Image.DecompressionBombWarning, action="ignore"):
            return Image.open(io.BytesIO(data))
    except Image.DecompressionBombError as error:
        raise LimitError(path, TEXTURE_TOO_LARGE) from error
    except (OSError, ValueError, SyntaxError):
        return None


def join_parts(path: AnyPath, parts: Sequence[MeshPart]) -> tuple[Mesh, np.ndarray]:
    """Merge mesh parts into one mesh near the origin.

    Returns:
        The mesh, and the offset that was subtracted from its vertices as float64 [3].

    Raises:
        DamagedFileError: If most vertices are not finite, a face index is invalid or a texture
            image is damaged.
        LimitError: If the mesh or one of its textures is too large.
    """
    check_sizes(path, sum(len(p.vertices) for p in parts), sum(len(p.faces) for p in parts))
    for part in parts:
        if len(part.faces) and not 0 <= part.faces.min() <= part.faces.max() < len(part.vertices):
            raise DamagedFileError(
                path, "contains faces that refer to missing vertices; export the file again"
            )
    vertices = np.concatenate([np.zeros((0, 3)), *(part.vertices for part in parts)])
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = np.concatenate(
        [np.zeros((0, 3), np.int64), *(p.faces + s for p, s in zip(parts, starts, strict=False))]
    )
    good = are_places(vertices)
    if len(good) and good.mean() < 0.5:
        raise DamagedFileError(
            path, "contains vertex positions that are NaN or infinite; export the file again"
        )
    whole = good[faces].all(axis=1) if len(faces) else np.zeros(0, bool)
    offset = np.floor(np.median(vertices[good], axis=0)) if good.any() else np.zeros(3)
    vertices = np.where(good[:, None], vertices, offset)
    pixels, sizes, numbers = _pictures(path, parts)
    image = np.repeat(np.array(numbers, np.int16), [len(p.faces) for p in parts])
    labels = np.concatenate(
        [np.zeros(0, np.uint8), *(np.broadcast_to(p.label, len(p.faces)) for p in parts)]
    ).astype(np.uint8)
    pictured = bool(len(pixels))
    mesh = Mesh(
        (vertices - offset).astype(np.float32),
        faces[whole].astype(np.int32),
        _colours(parts),
        _uv(parts) if pictured else None,
        image[whole] if pictured else None,
        pixels,
        sizes,
        labels[whole] if (labels != 255).any() else None,
    )
    return mesh, offset


def _colours(parts: Sequence[MeshPart]) -> np.ndarray | None:
    if all(part.colour is None for part in parts):
        return None
    grey = np.full((1, 3), GREY, np.uint8)
    return np.concatenate(
        [np.repeat(grey, len(p.vertices), axis=0) if p.colour is None else p.colour for p in parts]
    )


def _uv(parts: Sequence[MeshPart]) -> np.ndarray:
    uv = [np.zeros((len(p.vertices), 2)) if p.uv is None else p.uv for p in parts]
    return np.nan_to_num(np.concatenate(uv), posinf=0, neginf=0).astype(np.float32)


def _pictures(path: AnyPath, parts: Sequence[MeshPart]) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Return the pixels and sizes of the distinct textures, and the texture index of each part."""
    numbers: list[int] = []
    known: dict[tuple, int] = {}
    chosen: list[tuple[Image.Image, tuple[int, int, int]]] = []
    for part in parts:
        if part.picture is None or part.uv is None:
            numbers.append(-1)
            continue
        if part.picture.width * part.picture.height > MAX_PIXELS:
            raise LimitError(path, TEXTURE_TOO_LARGE)
        key = (id(part.picture), part.tint)
        if key not in known:
            known[key] = len(chosen)
            chosen.append((part.picture, part.tint))
        numbers.append(known[key])
    total = sum(picture.width * picture.height for picture, _ in chosen)
    shrink = max(1, int(np.ceil(np.sqrt(total / MAX_TEXTURE_PIXELS))))
    arrays = [_decode_picture(path, picture, tint, shrink) for picture, tint in chosen]
    sizes = np.array([(a.shape[1], a.shape[0]) for a in arrays], np.int64).reshape(-1, 2)
    flat = [np.zeros((0, 3), np.uint8), *(a.reshape(-1, 3) for a in arrays)]
    return np.concatenate(flat), sizes, numbers


def _decode_picture(
    path: AnyPath, picture: Image.Image, tint: tuple[int, int, int], shrink: int
) -> np.ndarray:
    try:
        image = picture.convert("RGB")
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        raise DamagedFileError(
            path, "contains a damaged texture image; export the file again"
        ) from error
    array = np.asarray(image.reduce(shrink) if shrink > 1 else image, np.uint8)
    if tint == (255, 255, 255):
        return array
    return (array.astype(np.uint16) * np.array(tint, np.uint16) // 255).astype(np.uint8)
