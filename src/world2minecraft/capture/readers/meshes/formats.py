"""Which file of a place is the solid, and who reads it."""

from pathlib import Path

from world2minecraft.capture.readers.meshes.s3dis import load_s3dis
from world2minecraft.capture.readers.meshes.surface_model import Loaded
from world2minecraft.core.archives import AnyPath, ArchivePath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.registry import Registry

# Where one solid is exported in several ways side by side, the first is taken.
READERS = {
    ".glb": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".gltf": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".obj": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".usdz": "world2minecraft.capture.readers.meshes.usd:load_usd",
    ".usdc": "world2minecraft.capture.readers.meshes.usd:load_usd",
    ".usda": "world2minecraft.capture.readers.meshes.usd:load_usd",
    ".usd": "world2minecraft.capture.readers.meshes.usd:load_usd",
    ".ply": "world2minecraft.capture.readers.meshes.ply_solid:load_ply",
    ".stl": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".off": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".e57": "world2minecraft.capture.readers.meshes.survey_clouds:load_e57",
    ".laz": "world2minecraft.capture.readers.meshes.survey_clouds:load_las",
    ".las": "world2minecraft.capture.readers.meshes.survey_clouds:load_las",
    ".pts": "world2minecraft.capture.readers.meshes.text:load_text",
    ".xyz": "world2minecraft.capture.readers.meshes.text:load_text",
    ".xyzrgb": "world2minecraft.capture.readers.meshes.text:load_text",
    ".asc": "world2minecraft.capture.readers.meshes.text:load_text",
    ".txt": "world2minecraft.capture.readers.meshes.text:load_text",
    ".csv": "world2minecraft.capture.readers.meshes.text:load_text",
}
VAGUE = (".txt", ".csv", ".asc")  # Anything may be in them: taken only where they are named.
SOLID_READERS = Registry("solid format", READERS)
ANNOTATIONS = "Annotations"  # S3DIS: one file a thing, in a folder beside the room's own.
LABELLED = ".labels"  # ScanNet: the same mesh again, coloured by class.


def find_solid(place: AnyPath) -> AnyPath | None:
    """Return the file of a place that is a mesh or a cloud, the folder of an S3DIS room, or None.

    Raises:
        CaptureError: a folder holds several different ones.
    """
    if place.is_file():
        return place if place.suffix.lower() in READERS else None
    if not place.is_dir():
        return None
    if any((place / ANNOTATIONS).glob("*.txt")) if (place / ANNOTATIONS).is_dir() else False:
        return place
    order = [suffix for suffix in READERS if suffix not in VAGUE]
    found = [entry for entry in place.iterdir() if entry.suffix.lower() in order]
    found = [entry for entry in found if entry.is_file() and not entry.name.startswith(".")]
    plain = [entry for entry in found if not entry.stem.endswith(LABELLED)] or found
    stems = {entry.stem for entry in plain}
    if len(stems) > 1:
        raise CaptureError(
            place, f"holds {len(stems)} meshes or clouds ({', '.join(sorted(stems)[:4])}); name one"
        )
    return min(plain, key=lambda e: (order.index(e.suffix.lower()), e.name), default=None)


def load_solid(place: AnyPath) -> Loaded:
    """Read a file that ``find_solid`` found. Raises what its reader raises."""
    if place.is_dir():
        return load_s3dis(place)
    return SOLID_READERS.load(place.suffix.lower())(place)


def stamp_of(place: AnyPath) -> tuple[int, ...]:
    """Return what changes when a file does: its size and time."""
    file = Path(place.path) if isinstance(place, ArchivePath) else place
    found = file.stat()
    return found.st_size, found.st_mtime_ns
