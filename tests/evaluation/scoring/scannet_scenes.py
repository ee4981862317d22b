"""A scene as ScanNet publishes it, written from a generated room by code that reads none of it.

The mesh has two triangles for each face of a 2 cm voxel that air touches, as its README says the
files are: binary little-endian PLY, ``segIndices`` of each vertex, ``segGroups`` of segments.
"""

import io
import json
import struct
import zlib
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.procgen import generate_room
from world2minecraft.procgen.sensors.scan_frames import room_to_scan
from world2minecraft.procgen.virtual_scan import room_views

NAME = "scene0000_00"
SEED = 500
# The NYU40 number of each class: ceiling, floor, wall, window, chair, bed ...
NYU40 = np.array([0, 22, 2, 1, 9, 5, 4, 6, 7, 25, 39, 40], np.uint16)
LIFT_M = np.array([0.3, -0.2, 0.07])  # Published alignments leave the floor some way off zero.


def small_room():
    """The room that is scanned."""
    return generate_room(SEED, kind="study")


def scan_to_aligned() -> np.ndarray:
    """What ``axisAlignment`` states: the room's own axes, at a place of its own."""
    aligned = np.linalg.inv(room_to_scan(SEED))
    aligned[:3, 3] += LIFT_M
    return aligned


def write_scene(folder: Path, room, *, flip: bool = False, frames: int = 30) -> Path:
    """Write all files of a scene; ``flip`` counts corners the other way round."""
    folder.mkdir(parents=True, exist_ok=True)
    views = list(room_views(room, sensor="clean", frames=frames, seed=SEED, width=160, height=120))
    (folder / f"{NAME}.sens").write_bytes(sens_bytes(views))
    rows = " ".join(f"{value:.8f}" for value in scan_to_aligned().reshape(-1))
    (folder / f"{NAME}.txt").write_text(f"axisAlignment = {rows} \nsceneType = Study\n")
    corners, labels, owners = mesh_of(room)
    scan_m = corners @ room_to_scan(SEED)[:3, :3].T + room_to_scan(SEED)[:3, 3]
    faces = np.arange(len(scan_m)).reshape(-1, 3)
    write_ply(
        folder / f"{NAME}_vh_clean_2.labels.ply",
        scan_m,
        faces[:, ::-1] if flip else faces,
        NYU40[labels],
    )
    write_groups(folder, room, labels, owners)
    return folder


def mesh_of(room):
    """Triangles' corners float [3T, 3] in the room, their classes and instances [3T]."""
    solid = room.labels > 0
    corners, labels, owners = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            air = np.zeros_like(solid)
            here, there = [slice(None)] * 3, [slice(None)] * 3
            here[axis] = slice(1, None) if sign < 0 else slice(None, -1)
            there[axis] = slice(None, -1) if sign < 0 else slice(1, None)
            air[tuple(here)] = ~solid[tuple(there)]
            cells = np.argwhere(solid & air)
            u, v = (axis + 1) % 3, (axis + 2) % 3
            square = np.zeros((4, 3))
            square[1:3, u], square[2:, v] = 1, 1
            square[:, axis] = max(sign, 0)
            order = [0, 1, 2, 0, 2, 3] if sign > 0 else [0, 2, 1, 0, 3, 2]
            corners.append((cells[:, None] + square[order]).reshape(-1, 3))
            labels.append(np.repeat(room.labels[tuple(cells.T)], 6))
            owners.append(np.repeat(room.instance[tuple(cells.T)], 6))
    places = np.concatenate(corners) * room.voxel_m + room.origin_m
    return places, np.concatenate(labels), np.concatenate(owners)


def write_ply(path: Path, places, faces, labels) -> None:
    """Colours, then the label, as in the published meshes."""
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
        f"property ushort label\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    kind = [("at", "<f4", 3), ("colour", "u1", 4), ("label", "<u2")]
    vertices = np.zeros(len(places), kind)
    vertices["at"], vertices["label"] = places, labels
    rows = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    path.write_bytes(head.encode() + vertices.tobytes() + rows.tobytes())


def write_groups(folder: Path, room, labels, owners) -> None:
    """A segment for each object, and one for each class of structure, which are groups too."""
    segments = np.where(owners > 0, 100 + owners.astype(int), labels)
    (folder / f"{NAME}_vh_clean_2.0.010000.segs.json").write_text(
        json.dumps({"sceneId": NAME, "segIndices": segments.tolist()})
    )
    seen = set(segments.tolist())
    groups = [(item.name, 100 + n) for n, item in enumerate(room.objects, 1) if 100 + n in seen]
    groups += [(name, n) for name, n in (("floor", 2), ("wall", 3)) if n in seen]
    rows = [
        {"id": n, "objectId": n, "segments": [segment], "label": name}
        for n, (name, segment) in enumerate(groups)
    ]
    (folder / f"{NAME}.aggregation.json").write_text(
        json.dumps({"sceneId": f"scannet.{NAME}", "segGroups": rows})
    )


def sens_bytes(views) -> bytes:
    """Version 4, JPEG and zlib, millimetres; pixel centres are whole numbers."""
    camera = views[0].colour_camera
    lens = np.eye(4)
    lens[[0, 1, 0, 1], [0, 1, 2, 2]] = (
        camera.fx_px, camera.fy_px, camera.cx_px - 0.5, camera.cy_px - 0.5,
    )  # fmt: skip
    still, size = np.eye(4).astype("<f4").tobytes(), (camera.width_px, camera.height_px)
    name, matrix = b"StructureSensor", lens.astype("<f4").tobytes()
    parts = [struct.pack("<IQ", 4, len(name)), name, matrix, still, matrix, still]
    parts.append(struct.pack("<ii4IfQ", 2, 1, *size, *size, 1000.0, len(views)))
    for number, view in enumerate(views):
        stream = io.BytesIO()
        Image.fromarray(view.colour).save(stream, "JPEG", quality=95)
        depth = zlib.compress(np.round(view.depth_m * 1000).astype("<u2").tobytes())
        parts.append(np.asarray(view.camera_to_scan, "<f4").tobytes())
        parts.append(struct.pack("<4Q", number, number, len(stream.getvalue()), len(depth)))
        parts += [stream.getvalue(), depth]
    return b"".join(parts)
