"""The inputs of ``check_photos``: one room as depth, as posed colour and as colour alone."""

import json
import shutil
from pathlib import Path

import numpy as np


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
    """Write a generated room as noise-free depth, as posed photos and as photos alone."""
    from world2minecraft.rooms import generate_room, scan_room

    if (folder / "poses.json").is_file():
        return
    room = generate_room(seed)
    scan_room(room, folder / "depth", sensor="clean", frames=frames, seed=seed)
    scan_room(room, folder / "posed", sensor="photo", frames=frames, seed=seed)
    scan_room(room, folder / "unposed", sensor="photos", frames=frames, seed=seed)
    stated = json.loads((folder / "depth" / "capture.json").read_text())["frames"]
    poses = {frame["name"]: frame["camera_to_world"] for frame in stated}
    (folder / "poses.json").write_text(json.dumps(poses))
