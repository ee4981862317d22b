"""Writes small captures as phone apps export them, from the formats' published descriptions.

- Record3D: what its author says of the files inside a ``.r3d`` (github.com/marek-simonik/record3d,
  issues 7, 27, 36, 64, 83, 93), and LZFSE's block headers (github.com/lzfse/lzfse).
- Polycam: the data format in the README of github.com/PolyCam/polyform.
- Stray Scanner: docs/format.md and issues 1 and 11 of github.com/strayrobots/scanner.
- ARKitScenes: DATA.md, raw/README.md and issue 81 of github.com/apple/ARKitScenes.
- 3D Scanner App: the keys of "All Data" as public readers of it use them.

Nothing here uses the readers. ARKit's axes are written out: a camera that looks along -z, y up.
"""

import json
import struct
import zipfile
from dataclasses import dataclass

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

from world2minecraft.core.types import Camera

WIDE = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)
DEEP = Camera(80, 60, 65.0, 65.0, 40.0, 30.0)
FLIPPED = np.diag([1.0, -1.0, -1.0, 1.0])
# The room's z is ARKit's y; the session began somewhere, turned by some angle.
ROOM_TO_ARKIT = np.eye(4)
ROOM_TO_ARKIT[:3, :3] = Rotation.from_euler("y", 25, degrees=True).as_matrix() @ [
    [1, 0, 0],
    [0, 0, 1],
    [0, -1, 0],
]
ROOM_TO_ARKIT[:3, 3] = [-1.2, -1.4, 0.7]
SIDEWAYS = np.eye(4)  # The sensor of a phone that is held upright: its right is down.
SIDEWAYS[:2, :2] = [[0, -1], [1, 0]]


@dataclass
class Shot:
    """One frame: ``pose`` is camera to the app's world with OpenCV axes."""

    pose: np.ndarray
    colour: np.ndarray
    depth_m: np.ndarray
    trust: np.ndarray


def shots_of(room, count=12, world=ROOM_TO_ARKIT, roll=None):
    """Look at the room ``count`` times; ``roll`` turns the sensor about its axis."""
    found = []
    for pose in room.poses(count):
        rolled = pose if roll is None else pose @ roll
        depth, _ = room.render(rolled, DEEP)
        _, colour = room.render(rolled, WIDE)
        trust = np.full(depth.shape, 2, np.uint8)
        trust[:2], trust[2:4] = 0, 1
        found.append(Shot(world @ rolled, colour, depth, trust))
    return found


def zipped(folder, path, inside=""):
    """Pack a folder's files into a zip, below a folder of the zip."""
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                archive.write(file, f"{inside}{file.relative_to(folder).as_posix()}")
    return path


def stored_lzfse(data):
    """LZFSE's block of bytes that are kept as they are, and its end."""
    return b"bvx-" + struct.pack("<I", len(data)) + data + b"bvx$"


def write_record3d(folder, shots, pack=stored_lzfse, **other):
    frames = folder / "rgbd"
    frames.mkdir(parents=True, exist_ok=True)
    for index, shot in enumerate(shots):
        Image.fromarray(shot.colour).save(frames / f"{index}.jpg", quality=95, subsampling=0)
        depth = shot.depth_m.astype("<f4").tobytes()
        (frames / f"{index}.depth").write_bytes(pack(depth))
        (frames / f"{index}.conf").write_bytes(pack(shot.trust.tobytes()))
    poses = [shot.pose @ FLIPPED for shot in shots]
    stated = {
        "w": 160,
        "h": 120,
        "dw": 80,
        "dh": 60,
        "fps": 60,
        "K": [130.0, 0, 0, 0, 130.0, 0, 80.0, 60.0, 1],
        "initPose": [0, 0, 0, 1, 0, 0, 0],
        "poses": [
            [*Rotation.from_matrix(pose[:3, :3]).as_quat().tolist(), *pose[:3, 3].tolist()]
            for pose in poses
        ],
        "frameTimestamps": [index / 60 for index in range(len(shots))],
    } | other
    (folder / "metadata").write_text(json.dumps(stated))


def write_polycam(folder, shots, corrected=True):
    keyframes = folder / "keyframes"
    prefix = "corrected_" if corrected else ""
    kinds = ("depth", "confidence", f"{prefix}images", f"{prefix}cameras")
    for kind in (*kinds, "images", "cameras"):
        (keyframes / kind).mkdir(parents=True, exist_ok=True)
    for index, shot in enumerate(shots):
        stem = str(1_442_008_525_605 + 250_000 * index)
        picture = Image.fromarray(shot.colour)
        picture.save(keyframes / f"{prefix}images" / f"{stem}.jpg", quality=95, subsampling=0)
        Image.fromarray(millimetres(shot)).save(keyframes / "depth" / f"{stem}.png")
        levels = np.array([0, 127, 255], np.uint8)[shot.trust]
        Image.fromarray(levels).save(keyframes / "confidence" / f"{stem}.png")
        pose = shot.pose @ FLIPPED
        stated = {f"t_{row}{column}": pose[row, column] for row in range(3) for column in range(4)}
        stated |= {"fx": 130.0, "fy": 130.0, "cx": 80.0, "cy": 60.0, "width": 160, "height": 120}
        stated |= {"blur_score": 105.3, "timestamp": int(stem)}
        path = keyframes / f"{prefix}cameras" / f"{stem}.json"
        path.write_text(json.dumps(stated))
    (folder / "mesh_info.json").write_text(json.dumps({"alignmentTransform": list(range(16))}))


def write_stray(folder, shots, video=True):
    for kind in ("depth", "confidence", *(() if video else ("rgb",))):
        (folder / kind).mkdir(parents=True, exist_ok=True)
    lines = ["timestamp, frame, x, y, z, qx, qy, qz, qw"]
    for index, shot in enumerate(shots):
        Image.fromarray(millimetres(shot)).save(folder / "depth" / f"{index:06d}.png")
        Image.fromarray(shot.trust).save(folder / "confidence" / f"{index:06d}.png")
        quaternion = Rotation.from_matrix(shot.pose[:3, :3]).as_quat()
        row = [100 + index / 60, f"{index:06d}", *shot.pose[:3, 3], *quaternion]
        lines.append(", ".join(str(value) for value in row))
        if not video:
            Image.fromarray(shot.colour).save(folder / "rgb" / f"{index:06d}.png")
    (folder / "odometry.csv").write_text("\n".join(lines) + "\n")
    (folder / "camera_matrix.csv").write_text("130.0,0.0,80.0\n0.0,130.0,60.0\n0.0,0.0,1.0\n")
    (folder / "imu.csv").write_text("timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z\n")
    if video:
        write_video(folder / "rgb.mp4", [shot.colour for shot in shots])


def write_video(path, pictures):
    """Write pictures as MPEG-4 with a key picture at every fifth."""
    import av

    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=30)
        stream.width, stream.height = pictures[0].shape[1], pictures[0].shape[0]
        stream.pix_fmt, stream.gop_size, stream.bit_rate = "yuv420p", 5, 8_000_000
        for picture in pictures:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())


def write_arkitscenes(folder, shots, video="41069021", late_s=0.0):
    """Poses every 0.1 s; images ``late_s`` after them, and two more between any two poses."""
    folders = ("lowres_wide", "lowres_depth", "confidence", "lowres_wide_intrinsics")
    for kind in folders:
        (folder / kind).mkdir(parents=True, exist_ok=True)
    rows = []
    for index, shot in enumerate(shots):
        seconds = 305.377 + 0.1 * index
        inverse = np.linalg.inv(shot.pose)
        turn = Rotation.from_matrix(inverse[:3, :3]).as_rotvec()
        rows.append(" ".join(str(value) for value in (seconds, *turn, *inverse[:3, 3])))
        for more_s in (0.0, 0.033, 0.067):
            stem = f"{video}_{seconds + late_s + more_s:.3f}"
            Image.fromarray(shot.colour).save(folder / "lowres_wide" / f"{stem}.png")
            Image.fromarray(millimetres(shot)).save(folder / "lowres_depth" / f"{stem}.png")
            Image.fromarray(shot.trust).save(folder / "confidence" / f"{stem}.png")
            stem = f"{video}_{seconds + late_s + more_s + 0.001:.3f}"  # As the data set does.
            lens = folder / "lowres_wide_intrinsics" / f"{stem}.pincam"
            lens.write_text("160 120 130.0 130.0 80.0 60.0")
    (folder / "lowres_wide.traj").write_text("\n".join(rows) + "\n")


def write_scanner_app(folder, shots, pictured_every=1):
    folder.mkdir(parents=True, exist_ok=True)
    for index, shot in enumerate(shots):
        if index % pictured_every == 0:
            picture = Image.fromarray(shot.colour)
            picture.save(folder / f"frame_{index:05d}.jpg", quality=95, subsampling=0)
        Image.fromarray(millimetres(shot)).save(folder / f"depth_{index:05d}.png")
        Image.fromarray(shot.trust).save(folder / f"conf_{index:05d}.png")
        stated = {
            "cameraPoseARFrame": (shot.pose @ FLIPPED).reshape(-1).tolist(),
            "intrinsics": [130.0, 0, 80.0, 0, 130.0, 60.0, 0, 0, 1],
            "motionQuality": 1,
            "frame_index": index,
            "time": index / 60,
        }
        (folder / f"frame_{index:05d}.json").write_text(json.dumps(stated))
    (folder / "info.json").write_text(json.dumps({"device": "iPhone"}))


def millimetres(shot):
    return np.round(shot.depth_m * 1000).astype(np.uint16)


WRITERS = {
    "record3d": write_record3d,
    "polycam": write_polycam,
    "stray": write_stray,
    "arkitscenes": write_arkitscenes,
    "scanner_app": write_scanner_app,
}
