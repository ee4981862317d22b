"""A reconstruction against an independent TSDF of the same frames.

``python -m benchmarks.check_tsdf FRAMES OUT [--every N --first K] [--json FILE]``

FRAMES is a folder of 7-Scenes frames, read here by plain numpy and Pillow; only ``scan_to_room``
of OUT/room.npz comes from the program. The TSDF (4 cm cells, 12 cm truncation, equal weights)
gives surface points at its sign changes; they mark reference voxels of 8 cm in the room frame.
Printed, within one voxel: precision of the observed cells, recall over all reference voxels, and
the share of the reference's free cells found free.
"""

import argparse
import json
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

CELL_M, TRUNCATION_M, MAX_DEPTH_M = 0.04, 0.12, 6.0
FOCAL_PX, MIDDLE_PX = 585.0, (320.0, 240.0)
PAD = 6  # Voxels around the grid in which the reference is looked for too.


def read_frames(folder: Path, every: int, first: int):
    """Yield depth float32 [H, W] in metres and camera-to-scan of each chosen frame."""
    for path in sorted(folder.glob("*depth.png"))[first::every]:
        depth = np.asarray(Image.open(path)).astype(np.float32)
        depth[depth == 65535] = 0
        pose = np.loadtxt(str(path).replace("depth.png", "pose.txt"))
        yield depth / 1000, pose


def integrate(frames, scan_to_room, low, shape):
    """Return the TSDF and its weights on a grid of CELL_M cells."""
    axes = [low[a] + (np.arange(shape[a]) + 0.5) * CELL_M for a in range(3)]
    centers = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    distance, weight = np.zeros(len(centers)), np.zeros(len(centers))
    for depth, pose in frames:
        to_camera = np.linalg.inv(scan_to_room @ pose)
        at = centers @ to_camera[:3, :3].T + to_camera[:3, 3]
        ahead = at[:, 2] > 0.1
        z = np.where(ahead, at[:, 2], 1)
        u = np.floor(at[:, 0] / z * FOCAL_PX + MIDDLE_PX[0]).astype(int)
        v = np.floor(at[:, 1] / z * FOCAL_PX + MIDDLE_PX[1]).astype(int)
        ahead &= (u >= 0) & (u < depth.shape[1]) & (v >= 0) & (v < depth.shape[0])
        seen = np.zeros(len(centers))
        seen[ahead] = depth[v[ahead], u[ahead]]
        use = (seen > 0) & (seen < MAX_DEPTH_M) & (seen - at[:, 2] > -TRUNCATION_M)
        value = np.minimum(seen - at[:, 2], TRUNCATION_M) / TRUNCATION_M
        distance[use] = (distance[use] * weight[use] + value[use]) / (weight[use] + 1)
        weight[use] += 1
    return distance.reshape(shape), weight.reshape(shape)


def surface_points(distance, weight, low):
    """Return the points [N, 3] where the TSDF changes sign between neighbouring cells."""
    points = []
    for axis in range(3):
        near = tuple(slice(0, -1) if a == axis else slice(None) for a in range(3))
        far = tuple(slice(1, None) if a == axis else slice(None) for a in range(3))
        a, b = distance[near], distance[far]
        crosses = (weight[near] > 0) & (weight[far] > 0) & (a * b < 0)
        crosses &= (np.abs(a) < 0.99) & (np.abs(b) < 0.99)
        at = low + (np.argwhere(crosses) + 0.5) * CELL_M
        at[:, axis] += a[crosses] / (a[crosses] - b[crosses]) * CELL_M
        points.append(at)
    return np.concatenate(points)


def compare(frames, room_file: Path) -> dict[str, float]:
    """Return the figures of one reconstruction against the frames' TSDF."""
    with np.load(room_file) as room:
        labels, source = room["labels"], room["source"]
        origin, voxel, scan_to_room = room["origin_m"], float(room["voxel_m"]), room["scan_to_room"]
    shape = np.array(labels.shape) + 2 * PAD
    low = origin - PAD * voxel
    distance, weight = integrate(frames, scan_to_room, low, shape * 2)
    reference = np.zeros(shape, bool)
    cells = np.floor((surface_points(distance, weight, low) - low) / voxel + 1e-9).astype(int)
    reference[tuple(cells.T)] = True
    occupied = np.pad((labels > 0) & (labels != 255), PAD)
    observed = occupied & np.pad(source == 1, PAD)
    free = np.pad(labels == 0, PAD)
    blocks = (shape[0], 2, shape[1], 2, shape[2], 2)
    known = weight.reshape(blocks) > 0
    is_free = (known & (distance.reshape(blocks) > 0)).all(axis=(1, 3, 5)) & ~reference
    unreached = ~known.any(axis=(1, 3, 5))
    grow = np.ones((3, 3, 3), bool)
    near_reference = ndimage.binary_dilation(reference, grow)
    return {
        "reference voxels": int(reference.sum()),
        "observed voxels": int(observed.sum()),
        "precision": float(near_reference[observed].mean()),
        "precision with completed": float(near_reference[occupied].mean()),
        "recall": float(ndimage.binary_dilation(observed, grow)[reference].mean()),
        "free recall": float(free[is_free].mean()),
        "called free, never reached": float((free & unreached).sum() / max(free.sum(), 1)),
    }


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("frames", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    frames = read_frames(chosen.frames, chosen.every, chosen.first)
    figures = compare(frames, chosen.out / "room.npz")
    for name, value in figures.items():
        print(f"{name:28} {value:.4f}" if isinstance(value, float) else f"{name:28} {value}")
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
