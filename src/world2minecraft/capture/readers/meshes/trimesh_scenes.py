"""Reader of glTF, OBJ, STL and OFF meshes by trimesh, restricted to files in the mesh's folder."""

import io
import json
import struct
from typing import Any
from urllib.parse import unquote

import numpy as np

from world2minecraft.capture.readers.meshes.colours_and_classes import class_of_name
from world2minecraft.capture.readers.meshes.mesh_and_cloud import (
    MAX_FACES,
    MAX_VERTICES,
    LoadedGeometry,
)
from world2minecraft.capture.readers.meshes.mesh_assembly import MeshPart, check_sizes, join_parts
from world2minecraft.capture.readers.meshes.optional_libraries import import_optional
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    reason_of,
)
from world2minecraft.core.files import read_bytes
from world2minecraft.geometry.colour import linear_to_srgb

MAX_BYTES = 2 << 30
MAX_JSON_BYTES = 64 << 20
MAX_NODES = 200_000
NO_COLOUR = (102, 102, 102, 255)  # What trimesh gives to materials that state none,
NO_PICTURE = (2, 2)  # and the picture's size.
UNSUPPORTED_EXTENSIONS = (
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_texture_basisu",
)
KINDS = {".glb": "glTF", ".gltf": "glTF", ".obj": "OBJ", ".stl": "STL", ".off": "OFF"}


def load_scene(path: AnyPath) -> LoadedGeometry:
    """Load a mesh file with all meshes of its scene.

    Raises:
        DamagedFileError: If the file cannot be read.
        LimitError: If the file is too large.
        InputError: If a file that the mesh refers to is missing.
        MissingExtraError: If trimesh is not installed.
    """
    trimesh = import_optional("trimesh", "reading meshes")
    data = read_bytes(path, MAX_BYTES)
    suffix = path.suffix.lower()
    tree = _checked_gltf(path, data) if suffix in (".glb", ".gltf") else {}
    if suffix == ".stl":
        _check_stl(path, data)
    options: dict[str, Any] = {"split_objects": True} if suffix == ".obj" else {}
    try:
        scene = trimesh.load_scene(
            io.BytesIO(data),
            file_type=suffix[1:],
            resolver=_FolderResolver(path),
            process=False,
            **options,
        )
        parts = _parts(path, scene, str(tree.get("asset", {}).get("generator", "")))
    except InputError:
        raise
    except Exception as error:  # What a hostile file makes trimesh raise has no common root.
        reason_text = reason_of(error)
        reason = (
            f"cannot be read as {KINDS.get(suffix, suffix)} ({reason_text}); export the file again"
        )
        raise DamagedFileError(path, reason) from error
    mesh, offset = join_parts(path, parts)
    notes = (
        ()
        if mesh.coloured
        else (("the mesh has no colours; export it with its textures in the same folder"),)
    )
    gltf = bool(tree)
    return LoadedGeometry(
        mesh,
        KINDS.get(suffix, suffix[1:].upper()),
        offset,
        unit_m=1.0 if gltf else None,
        usual_up="y" if gltf or suffix == ".obj" else "z",
        notes=notes,
    )


class _FolderResolver:
    """A trimesh resolver that only opens files in the folder of the mesh or below."""

    def __init__(self, path: AnyPath):
        self.path = path

    def get(self, key: str) -> bytes:
        """Return the bytes of a file that the mesh refers to.

        The file is searched for under its stated path and, because exporters often write absolute
        paths, under its base name next to the mesh. glTF names may be percent-encoded, and MTL
        names may follow options.

        Raises:
            DamagedFileError: If the name refers to a file outside the folder.
            InputError: If the file is not found.
        """
        name = key.strip().replace("\\", "/")
        names = [name, unquote(name), *(name.split()[-1:] if name.startswith("-") else [])]
        split = [[part for part in one.split("/") if part not in ("", ".")] for one in names]
        inside = [p for p, one in zip(split, names, strict=True) if p and _stays_in_folder(one, p)]
        last = [parts[-1:] for parts in split if parts and _stays_in_folder(parts[-1], parts[-1:])]
        for parts in (*inside, *last):
            found = self.path.parent
            for part in parts:
                found = found / part
            if found.is_file():
                return read_bytes(found, 1 << 30)
        if not inside:
            raise DamagedFileError(
                self.path,
                f"refers to a file outside its folder: {key[:80]!r}; copy that file next "
                "to the mesh",
            )
        raise InputError(
            self.path, f"refers to the missing file {key[:80]!r}; copy that file next to the mesh"
        )

    __getitem__ = get

    def namespaced(self, namespace: str) -> "_FolderResolver":
        """Return this resolver, because each name is checked separately."""
        return self

    def keys(self) -> list[str]:
        """Return the names of the files next to the mesh."""
        return [entry.name for entry in self.path.parent.iterdir() if entry.is_file()]

    def __contains__(self, key: str) -> bool:
        return key in self.keys()


def _stays_in_folder(name: str, parts: list[str]) -> bool:
    """Return whether a file name cannot refer to a file outside its folder."""
    return not name.startswith("/") and ".." not in parts and ":" not in parts[0]


def _checked_gltf(path: AnyPath, data: bytes) -> dict[str, Any]:
    """Return the JSON tree of a glTF file after checking its counts and extensions."""
    text = data
    if data[:4] == b"glTF":
        if len(data) < 20 or struct.unpack("<I", data[8:12])[0] > len(data):
            raise DamagedFileError(path, "is truncated; copy the file again")
        length = struct.unpack("<I", data[12:16])[0]
        text = data[20 : 20 + length]
    elif path.suffix.lower() == ".glb":
        raise DamagedFileError(
            path, "is not a binary glTF file (it does not start with glTF); export the file again"
        )
    if len(text) > MAX_JSON_BYTES:
        raise LimitError(
            path,
            f"has a JSON part of {len(text):,} bytes, the limit is "
            f"{MAX_JSON_BYTES:,}; export a simpler mesh",
        )
    try:
        tree = json.loads(text)
        extensions = tree.get("extensionsRequired", []) + tree.get("extensionsUsed", [])
        counts = [int(row["count"]) for row in tree.get("accessors", [])]
        nodes = len(tree.get("nodes", []))
    except (*MALFORMED, RecursionError) as error:
        raise DamagedFileError(
            path, "is not a valid glTF file: its JSON part cannot be read; export the file again"
        ) from error
    for name in UNSUPPORTED_EXTENSIONS:
        if name in extensions:
            raise DamagedFileError(
                path,
                f"uses the unsupported compression {name}; export the file without compression",
            )
    most = 3 * max(MAX_FACES, MAX_VERTICES)
    if any(not 0 <= count <= most for count in counts) or nodes > MAX_NODES:
        raise LimitError(
            path,
            f"declares {max([nodes, *counts]):,} values, too many for a room; check "
            "or simplify the file",
        )
    return tree


def _check_stl(path: AnyPath, data: bytes) -> None:
    if len(data) < 15:
        raise DamagedFileError(path, "is truncated; copy the file again")
    if data[:5].lower() == b"solid" and b"facet" in data[:2000]:
        return
    count = struct.unpack("<I", data[80:84])[0] if len(data) >= 84 else -1
    if count < 0 or 84 + 50 * count > len(data):
        raise DamagedFileError(
            path, f"is a truncated STL file: expected {count:,} triangles; copy the file again"
        )


def _parts(path: AnyPath, scene: Any, generator: str) -> list[MeshPart]:
    """Return the parts of a trimesh scene, transformed by their nodes."""
    nodes = list(scene.graph.nodes_geometry)
    shapes = [(node, *scene.graph[node]) for node in nodes]
    sizes = {name: _mesh_size(mesh) for name, mesh in scene.geometry.items()}
    check_sizes(
        path,
        sum(sizes[name][0] for _, _, name in shapes),
        sum(sizes[name][1] for _, _, name in shapes),
    )
    parts = []
    for node, transform, name in shapes:
        mesh = scene.geometry[name]
        if not sizes[name][1]:
            continue
        moved = np.asarray(mesh.vertices, np.float64) @ transform[:3, :3].T + transform[:3, 3]
        faces = np.asarray(mesh.faces, np.int64)
        if np.linalg.det(transform[:3, :3]) < 0:
            faces = faces[:, ::-1]  # A mirrored part turns its faces around.
        label = class_of_name(str(node))
        parts.append(
            _part(mesh, moved, faces, generator, label if label != 255 else class_of_name(name))
        )
    return parts


def _mesh_size(mesh: Any) -> tuple[int, int]:
    faces = getattr(mesh, "faces", None)
    return (0, 0) if faces is None else (len(mesh.vertices), len(faces))


def _part(
    mesh: Any, vertices: np.ndarray, faces: np.ndarray, generator: str, label: int
) -> MeshPart:
    visual = mesh.visual
    kind = getattr(visual, "kind", None)
    if kind == "face":
        colour = np.repeat(np.asarray(visual.face_colors)[:, :3], 3, axis=0).astype(np.uint8)
        own = np.arange(3 * len(faces)).reshape(-1, 3)
        return MeshPart(vertices[faces.reshape(-1)], own, colour, label=label)
    if kind == "vertex":
        colour = np.asarray(visual.vertex_colors)[:, :3].astype(np.uint8)
        if "Blender" in generator:  # It stores light, as glTF asks; scanners' exporters do not.
            colour = linear_to_srgb(colour / 255.0)
        return MeshPart(vertices, faces, colour, label=label)
    if kind == "texture":
        return _textured(visual, vertices, faces, generator, label)
    return MeshPart(vertices, faces, label=label)


def _textured(
    visual: Any, vertices: np.ndarray, faces: np.ndarray, generator: str, label: int
) -> MeshPart:
    material = visual.material
    picture = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    factor = getattr(material, "baseColorFactor", None)
    linear = factor is not None and "trimesh" not in generator
    if factor is None:
        factor = getattr(material, "diffuse", None)
        if factor is not None and tuple(factor) == NO_COLOUR:
            factor = None
            picture = None if picture is not None and picture.size == NO_PICTURE else picture
    tint = np.array([255, 255, 255], np.uint8)
    if factor is not None:
        values = np.asarray(factor, np.float64)[:3]
        values = values / 255.0 if np.asarray(factor).dtype.kind in "ui" else values
        tint = (
            linear_to_srgb(values) if linear else (values.clip(0, 1) * 255 + 0.5).astype(np.uint8)
        )
    uv = getattr(visual, "uv", None)
    if picture is not None and uv is not None and len(uv) == len(vertices):
        flipped = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
        shade = (int(tint[0]), int(tint[1]), int(tint[2]))
        # OBJ files state a grey that viewers do not multiply on pictures.
        shade = shade if hasattr(material, "baseColorFactor") else (255, 255, 255)
        return MeshPart(vertices, faces, None, picture, flipped, shade, label)
    if factor is None:
        return MeshPart(vertices, faces, label=label)
    return MeshPart(vertices, faces, np.repeat(tint[None], len(vertices), axis=0), label=label)
