"""Writes views in the layouts of others, as small as they can be."""

import json

import numpy as np
from PIL import Image

from world2minecraft.capture import write_plain
from world2minecraft.core.coordinates import OPENGL_TO_OPENCV


def write_seven_scenes(folder, views, *, colour_suffix=".jpg", intrinsics=True):
    folder.mkdir(parents=True, exist_ok=True)
    for index, view in enumerate(views):
        stem = folder / f"frame-{index:06d}"
        Image.fromarray(view.colour).save(f"{stem}.color{colour_suffix}")
        Image.fromarray(_millimetres(view)).save(f"{stem}.depth.png")
        np.savetxt(f"{stem}.pose.txt", view.camera_to_scan)
    if intrinsics:
        np.savetxt(folder / "camera-intrinsics.txt", views[0].depth_camera.matrix)


def write_nerfstudio(folder, views, *, per_frame=False, scale=1.0):
    (folder / "images").mkdir(parents=True, exist_ok=True)
    (folder / "depth").mkdir(exist_ok=True)
    camera = views[0].colour_camera
    lens = {"w": camera.width_px, "h": camera.height_px, "fl_x": camera.fx_px, "k1": 0.0}
    lens |= {"fl_y": camera.fy_px, "cx": camera.cx_px, "cy": camera.cy_px}
    frames = []
    for view in views:
        Image.fromarray(view.colour).save(folder / "images" / f"{view.name}.png")
        Image.fromarray(_millimetres(view)).save(folder / "depth" / f"{view.name}.png")
        pose = view.camera_to_scan @ OPENGL_TO_OPENCV
        pose[:3, 3] *= scale
        frame = {"file_path": f"images/{view.name}.png", "transform_matrix": pose.tolist()}
        frame["depth_file_path"] = f"depth/{view.name}.png"
        frames.append(frame | lens if per_frame else frame)
    stated = {"frames": frames[::-1], "camera_model": "OPENCV"} | ({} if per_frame else lens)
    if scale != 1.0:
        stated["applied_scale"] = scale
    (folder / "transforms.json").write_text(json.dumps(stated))


WRITERS = {
    "plain": write_plain,
    "seven_scenes": write_seven_scenes,
    "nerfstudio": write_nerfstudio,
}


def _millimetres(view):
    return np.round(view.depth_m * 1000).astype(np.uint16)
