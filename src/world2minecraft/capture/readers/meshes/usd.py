"""Parser of USD and USDZ files by Pixar's library, which the extra ``usd`` installs."""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.readers.meshes.colours_and_classes import class_of_name
from world2minecraft.capture.readers.meshes.mesh_and_cloud import LoadedGeometry
from world2minecraft.capture.readers.meshes.mesh_assembly import (
    MeshPart,
    check_sizes,
    join_parts,
    open_texture,
)
from world2minecraft.capture.readers.meshes.optional_libraries import import_optional
from world2minecraft.capture.readers.meshes.ply import triangulate_fans
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.geometry.colour import linear_to_srgb

MAX_PRIMS = 200_000
MAX_PICTURE_BYTES = 256 << 20


def read_stage(path: Path) -> LoadedGeometry:
    """Read all meshes of a USD stage on disk.

    Pixar's library may crash the process on a damaged file; ``usd_process`` protects from that.

    Raises:
        DamagedFileError: If the file cannot be read or refers to files outside its folder.
        LimitError: If the file is too large.
        MissingExtraError: If the USD library is not installed.
    """
    tf, usd, geom = _import_pxr("Tf"), _import_pxr("Usd"), _import_pxr("UsdGeom")
    try:
        stage = usd.Stage.Open(str(path))
    except tf.ErrorException as error:
        raise DamagedFileError(path, "cannot be read as USD; export the file again") from error
    if stage is None:
        raise DamagedFileError(path, "cannot be read as USD; export the file again")
    folder = str(path.resolve().parent)
    for layer in stage.GetUsedLayers():
        if layer.realPath and not Path(layer.realPath).is_relative_to(folder):
            raise DamagedFileError(
                path,
                f"refers to a file outside its folder: {layer.identifier[:80]}; export "
                "the scene as USDZ",
            )
    try:
        parts = _parts(path, stage, folder)
        mesh, offset = join_parts(path, parts)
        unit_m = float(geom.GetStageMetersPerUnit(stage))
        stated = bool(geom.StageHasAuthoredMetersPerUnit(stage))
        up = str(geom.GetStageUpAxis(stage)).lower()
        up_stated = bool(stage.HasAuthoredMetadata("upAxis"))
    except (tf.ErrorException, RuntimeError) as error:
        raise DamagedFileError(path, "cannot be read as USD; export the file again") from error
    # Without a stated unit USD means centimetres, yet files are often in metres: it is inferred.
    return LoadedGeometry(mesh, "USD", offset, unit_m if stated else None, up, up_stated)


def _import_pxr(name: str) -> Any:
    return import_optional(f"pxr.{name}", "reading USD files", "usd")


def _parts(place: AnyPath, stage: Any, folder: str) -> list[MeshPart]:
    places = _import_pxr("UsdGeom").XformCache()
    pictures: dict[str, Image.Image | None] = {}
    parts, vertices, faces = [], 0, 0
    predicate = _import_pxr("Usd").TraverseInstanceProxies(_import_pxr("Usd").PrimDefaultPredicate)
    for number, prim in enumerate(_import_pxr("Usd").PrimRange(stage.GetPseudoRoot(), predicate)):
        if number > MAX_PRIMS:
            raise LimitError(
                place,
                f"has more than {MAX_PRIMS:,} prims, too many for a room; export a smaller scene",
            )
        if not prim.IsA(_import_pxr("UsdGeom").Mesh):
            continue
        part = _part(place, prim, np.array(places.GetLocalToWorldTransform(prim)), pictures, folder)
        if part is not None:
            vertices, faces = vertices + len(part.vertices), faces + len(part.faces)
            check_sizes(place, vertices, faces)
            parts.append(part)
    return parts


def _part(
    place: AnyPath,
    prim: Any,
    transform: np.ndarray,
    pictures: dict[str, Image.Image | None],
    folder: str,
) -> MeshPart | None:
    shape = _import_pxr("UsdGeom").Mesh(prim)
    points = np.array(shape.GetPointsAttr().Get() or [], np.float64).reshape(-1, 3)
    counts = np.array(shape.GetFaceVertexCountsAttr().Get() or [], np.int64)
    corners = np.array(shape.GetFaceVertexIndicesAttr().Get() or [], np.int64)
    if not len(points) or not len(counts):
        return None
    if counts.min() < 0 or counts.sum() != len(corners) or corners.max() >= len(points):
        raise DamagedFileError(
            place, f"contains a mesh with invalid faces: {prim.GetPath()}; export the file again"
        )
    if corners.min() < 0:
        raise DamagedFileError(
            place, f"contains a mesh with invalid faces: {prim.GetPath()}; export the file again"
        )
    moved = points @ transform[:3, :3] + transform[3, :3]  # USD's vectors are rows.
    # Every corner becomes a vertex of its own: colours and uv may differ from face to face.
    order, owner = triangulate_fans(counts, np.arange(len(corners)))
    if shape.GetOrientationAttr().Get() == "leftHanded":
        order = order[:, ::-1]
    own = order.reshape(-1)
    picture, plain = _material(prim, pictures, folder)
    uv = _corner_values(
        _import_pxr("UsdGeom").PrimvarsAPI(prim), ("st", "UVMap", "st0"), corners, owner, own, 2
    )
    colour = _corner_values(
        _import_pxr("UsdGeom").PrimvarsAPI(prim), ("displayColor",), corners, owner, own, 3
    )
    if colour is not None:
        colour = linear_to_srgb(colour)
    elif plain is not None:
        colour = np.repeat(linear_to_srgb(plain)[None], len(own), axis=0)
    if uv is not None:
        uv = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
    label = next(
        (
            found
            for name in reversed(str(prim.GetPath()).split("/"))
            if (found := class_of_name(name)) != 255
        ),
        255,
    )
    faces = np.arange(len(own)).reshape(-1, 3)
    return MeshPart(
        moved[corners[own]], faces, colour, picture if uv is not None else None, uv, label=label
    )


def _corner_values(
    primvars: Any,
    names: tuple[str, ...],
    corners: np.ndarray,
    owner: np.ndarray,
    own: np.ndarray,
    width: int,
) -> np.ndarray | None:
    """Return a primvar at each corner of each triangle as float64 [3 T, width], or None."""
    for name in names:
        found = primvars.FindPrimvarWithInheritance(name)
        if not found or not found.HasValue():
            continue
        values = np.array(found.ComputeFlattened(), np.float64).reshape(-1, width)
        kind = found.GetInterpolation()
        index = {
            "constant": np.zeros(len(own), np.int64),
            "uniform": np.repeat(owner, 3),
            "vertex": corners[own],
            "varying": corners[own],
            "faceVarying": own,
        }.get(kind)
        if index is not None and len(values) and index.max() < len(values):
            return values[index]
    return None


def _material(
    prim: Any, pictures: dict[str, Image.Image | None], folder: str
) -> tuple[Image.Image | None, np.ndarray | None]:
    """Return the texture and the uniform colour (linear float64 [3]) of a prim's material."""
    material = _import_pxr("UsdShade").MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
    surface = material.ComputeSurfaceSource()[0] if material else None
    slot = surface.GetInput("diffuseColor") if surface else None
    if not slot:
        return None, None
    source = slot.GetConnectedSource()
    if not source:
        value = slot.Get()
        return None, None if value is None else np.array(value, np.float64)
    shader = _import_pxr("UsdShade").Shader(source[0].GetPrim())
    file = shader.GetInput("file") if shader else None
    asset = file.Get() if file else None
    if asset is None:
        return None, None
    where = asset.resolvedPath or asset.path
    if where not in pictures:
        pictures[where] = _open_picture(where, folder)
    return pictures[where], None


def _open_picture(where: str, folder: str) -> Image.Image | None:
    """Return the texture image of an asset, or None if it is missing, outside or not an image."""
    if not Path(where).is_relative_to(folder):
        return None
    asset = _import_pxr("Ar").GetResolver().OpenAsset(_import_pxr("Ar").ResolvedPath(where))
    if asset is None or asset.GetSize() > MAX_PICTURE_BYTES:
        return None
    return open_texture(Path(where), bytes(asset.GetBuffer()))
