"""The inputs of ``check_photos``: one room as depth, as posed colour and as colour alone."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.rooms.photo import prepare_photos, take_photo
from world2minecraft.rooms.room import Room
from world2minecraft.scan.plain import write_plain
from world2minecraft.types import Camera, View


def kitchen_inputs(source: Path, folder: Path, every: int = 1) -> None:
    """Link a 7-Scenes folder as ``depth``, ``posed`` and ``unposed``, and note its poses."""
    if (folder / "poses.json").is_file():
        return
    frames = sorted((source / "frames").glob("*.color.*"))[::every]
    poses = {}
    for colour in frames:
        stem = colour.name.split(".")[0]
        poses[stem] = np.loadtxt(source / "frames" / f"{stem}.pose.txt").tolist()
        for kind in ("depth", "posed"):
            place = folder / kind / "frames"
            place.mkdir(parents=True, exist_ok=True)
            for path in (colour, colour.parent / f"{stem}.pose.txt"):
                shutil.copy(path, place / path.name)
            shutil.copy(source / "camera-intrinsics.txt", folder / kind)
        shutil.copy(colour.parent / f"{stem}.depth.png", folder / "depth" / "frames")
        (folder / "unposed").mkdir(exist_ok=True)
        shutil.copy(colour, folder / "unposed" / f"{stem}{colour.suffix}")
    (folder / "poses.json").write_text(json.dumps(poses))


def room_inputs(seed: int, folder: Path, frames: int) -> None:
    """Write a generated room as posed photos, as photos alone and as noise-free depth.

    All three look from the same places the same way: what one cannot see none of them can.
    """
    from world2minecraft.rooms import generate_room, scan_room

    if (folder / "poses.json").is_file():
        return
    room = generate_room(seed)
    scan_room(room, folder / "posed", sensor="photo", frames=frames, seed=seed)
    (folder / "unposed").mkdir(parents=True, exist_ok=True)
    for photo in sorted((folder / "posed" / "colour").iterdir()):
        shutil.copy(photo, folder / "unposed")
    write_plain(folder / "depth", depth_views(room, folder / "posed"), depth_unit="m")
    stated = json.loads((folder / "depth" / "capture.json").read_text())["frames"]
    poses = {frame["name"]: frame["camera_to_world"] for frame in stated}
    (folder / "poses.json").write_text(json.dumps(poses))


def depth_views(room: Room, posed: Path) -> Iterator[View]:
    """Yield a virtual phone's photos of a room with exact depth."""
    scene = prepare_photos(room)
    stated = json.loads((posed / "capture.json").read_text())
    camera = Camera(**stated["colour_camera"])
    with np.load(posed / "truth.npz") as truth:
        places = dict(zip(truth["frame_names"].tolist(), truth["camera_to_truth"], strict=True))
    for frame in stated["frames"]:
        name, pose = frame["name"], np.array(frame["camera_to_world"])
        colour = np.asarray(Image.open(posed / "colour" / f"{name}.jpg"))
        depth_m = take_photo(scene, camera, places[name]).depth_m
        yield View(name, pose, colour, camera, depth_m, camera)
