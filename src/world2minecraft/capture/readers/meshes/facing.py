"""Whether the faces that are seen from inside turn their backs."""

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_rasterizer import NO_FACE, faces_seen
from world2minecraft.capture.readers.meshes.surface_model import Mesh
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.types import Camera

LOOKS = 12
SMALL = 8  # Times smaller images tell it as well.


def outward_share(mesh: Mesh, camera: Camera, camera_to_world: np.ndarray) -> float:
    """Return the share of pixels of the first views that see the back of a triangle."""
    small = camera.resized(camera.width_px // SMALL, camera.height_px // SMALL)
    backs, total = 0, 0
    for pose in camera_to_world[:LOOKS]:
        seen = faces_seen(mesh, small, invert_rigid(pose))
        faces = mesh.faces[seen[seen != NO_FACE]]
        corners = apply(invert_rigid(pose), mesh.vertices[faces].astype(np.float64))
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        backs += int((np.einsum("fa,fa->f", across, corners[:, 0]) > 0).sum())
        total += len(faces)
    return backs / max(total, 1)
