"""What docs/datasets.md says in figures: ``python -m benchmarks.check_datasets``.

First a ScanNet file of 1,500 frames is made and looked through as ``w2m scan`` does: seconds of
CPU and peak memory. Then, where the shared real inputs are there (W2M_SHARED_DATA), the depth
edges of one real NYU frame are laid on its colours through the two published lenses: with the
signs as we read them, with those that the toolbox writes, and with one lens for both. The score
is the mean colour change under the edges, less that of the image; chance gives 0.
"""

import io
import os
import resource
import struct
import tempfile
import time
import zlib
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_gradient_magnitude, minimum_filter

from world2minecraft.geometry.lifting import pixel_rays, project
from world2minecraft.scan import describe_capture
from world2minecraft.scan.datasets import nyu_raw
from world2minecraft.scan.datasets.lenses import VGA, stated_camera
from world2minecraft.scan.depth import DepthEncoding
from world2minecraft.scan.images import read_colour, read_raw

FRAMES = 1500
COLOUR, DEPTH = (1296, 968), (640, 480)
JUMP_M = 0.15


def main() -> None:
    """Print both."""
    with tempfile.TemporaryDirectory() as folder:
        _look_through(Path(folder) / "scene0000_00.sens")
    shared = Path(os.environ.get("W2M_SHARED_DATA", "../shared/data"))
    frame = shared / "open3d_rgbd_samples" / "RGBD" / "other_formats"
    if frame.is_dir():
        _nyu_lenses(frame)
    else:
        print(f"no real NYU frame at {frame}")


def _look_through(path: Path) -> None:
    _write_sens(path)
    start = time.process_time()
    summary = describe_capture(path)
    seconds = time.process_time() - start
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    size_mb = path.stat().st_size / 1e6
    print(
        f".sens: {summary.usable} frames, {size_mb:.0f} MB: {seconds:.1f} s, peak {peak_mb:.0f} MB"
    )


def _write_sens(path: Path) -> None:
    """Write frames of noise as detailed as real ones, about 660 kB each."""
    rng = np.random.default_rng(0)
    small = rng.integers(0, 256, (COLOUR[1] // 4, COLOUR[0] // 4, 3)).astype(np.uint8)
    stream = io.BytesIO()
    Image.fromarray(small).resize(COLOUR).save(stream, "JPEG", quality=80)
    depth = (2000 + rng.normal(0, 4, DEPTH[::-1])).astype("<u2")
    images = (stream.getvalue(), zlib.compress(depth.tobytes(), 6))
    pose = np.eye(4, dtype="<f4").tobytes()
    lenses = [[1170.2, 647.75, 483.75], [577.9, 319.5, 239.5]]
    head = [struct.pack("<IQ", 4, 0)]
    for focal, cx, cy in lenses:
        matrix = np.array([[focal, 0, cx, 0], [0, focal, cy, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        head += [matrix.astype("<f4").tobytes(), pose]
    head.append(struct.pack("<ii4IfQ", 2, 1, *COLOUR, *DEPTH, 1000.0, FRAMES))
    with path.open("wb") as file:
        file.write(b"".join(head))
        for number in range(FRAMES):
            sizes = struct.pack("<4Q", number, number, *(len(image) for image in images))
            file.write(pose + sizes + images[0] + images[1])


def _nyu_lenses(folder: Path) -> None:
    depth_m = DepthEncoding("nyu_raw").to_metres(read_raw(folder / "NYU_depth.pgm"))
    colour = read_colour(folder / "NYU_color.ppm")
    ours = nyu_raw._depth_to_colour()
    written = ours.copy()
    written[:3, 3] *= -1
    for said, transform in (("ours", ours), ("shift as written", written), ("none", np.eye(4))):
        print(f"NYU lenses, {said}: {_score(depth_m, colour, transform):.3f}")


def _score(depth_m: np.ndarray, colour: np.ndarray, depth_to_colour: np.ndarray) -> float:
    """Return the mean colour change under the borders of depth, less that of the image."""
    depth_camera = stated_camera(Path(), VGA, *nyu_raw.DEPTH)
    camera = stated_camera(Path(), VGA, *nyu_raw.COLOUR)
    near = minimum_filter(np.where(depth_m > 0, depth_m, np.inf), 3)
    edges = (depth_m > 0) & (depth_m == near) & np.isfinite(near)
    far = np.zeros(depth_m.shape, bool)
    for axis in (0, 1):
        for step in (-2, 2):
            other = np.roll(depth_m, step, axis)
            far |= other - depth_m > JUMP_M
    edges &= far
    edges[:4] = edges[-4:] = edges[:, :4] = edges[:, -4:] = False
    rays = pixel_rays(depth_camera)[edges].astype(np.float64)
    points = np.column_stack([rays, np.ones(len(rays))]) * depth_m[edges][:, None]
    seen = points @ depth_to_colour[:3, :3].T + depth_to_colour[:3, 3]
    u, v = np.floor(project(seen, camera)).astype(int).T
    inside = (u >= 0) & (u < VGA[0]) & (v >= 0) & (v < VGA[1])
    change = gaussian_gradient_magnitude(colour.mean(axis=2), 1.5)
    change = change / (change + np.percentile(change, 85))
    return float(change[v[inside], u[inside]].mean() - change.mean())


if __name__ == "__main__":
    main()
