"""Rooms of S3DIS: ``Annotations/chair_1.txt`` and its like, a cloud for each thing."""

from world2minecraft.capture.readers.meshes.surface_model import Loaded
from world2minecraft.capture.readers.meshes.text import add_text, label_of_file
from world2minecraft.capture.readers.meshes.thinning import Thinner
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError

FOLDER = "Annotations"
MAX_FILES = 5000


def load_s3dis(place: AnyPath) -> Loaded:
    """Read a room's folder.

    Raises:
        CaptureError: it has no points. DamagedFileError: a file is no cloud.
    """
    thinner = Thinner(unit_m=1.0)
    files = sorted((place / FOLDER).glob("*.txt"), key=lambda path: path.name)[:MAX_FILES]
    for path in files:
        add_text(path, thinner, label_of_file(path.stem))
    if thinner.offset is None:
        raise CaptureError(place, f"has no points in {FOLDER}/*.txt")
    note = f"classes are told by the names of {len(files)} files in {FOLDER}"
    cloud = thinner.cloud()
    return Loaded(cloud, "S3DIS", thinner.offset, 1.0, "z", True, (note,), thinner.read)
