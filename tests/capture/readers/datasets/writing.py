"""Parts of writers that several formats share; each format's own lies in its test."""

import io
import zipfile

import numpy as np
from PIL import Image


def encoded(pixels, kind):
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, kind)
    return stream.getvalue()


def millimetres(view):
    return np.round(view.depth_m * 1000).astype(np.uint16)


def save(path, pixels):
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(pixels).save(path)


def save_text(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def zipped(folder, path):
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file() and file != path:
                archive.write(file, file.relative_to(folder))
    return path


def quaternion(rotation):
    """The quaternion x y z w of a rotation, by scipy and not by our own code."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(rotation).as_quat()
