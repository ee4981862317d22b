"""The rooms of the shared inputs: how each becomes a capture, and what is known about it.

``data/README.md`` of the shared inputs describes their sources and licences. None of them, and no
picture of them, may be committed.
"""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.core.types import Camera, View
from world2minecraft.geometry.unprojection import unproject_depth

KITCHEN = "redkitchen_rgbd"
KITCHEN_UP = (0.0136, -0.8910, -0.4539)  # Good to 0.3 to 0.5 degrees.
KITCHEN_FLOOR_M = -1.535  # Along KITCHEN_UP, from the origin of the world frame.
KITCHEN_CAMERA = Camera(640, 480, 585, 585, 320, 240)
KITCHEN_WINDOWS = ((0, 20), (10, 30), (20, 40))
CROP_M = 1.3
NYU_CAMERA = Camera(640, 480, 518.86, 519.47, 325.58, 253.74)
NYU_FOLDER = "nyuv2_train"
NYU_DEPTH_STEP_M = 10 / 255
NYU_IGNORED = 39  # Other props, unlabelled pixels and borders between objects.
# Azure Kinect, 4:3 colour mode, scaled to 1440 pixels: the data set states no intrinsics.
AZURE_CAMERA = Camera(1440, 1080, 686, 686, 720, 540)

Prepare = Callable[[Path, Path], Path]


@dataclass(frozen=True)
class Reference:
    """What is known about a room.

    Attributes:
        up: Up direction in the capture's frame.
        floor_m: Height of the floor above the origin of that frame, along ``up``.
        finds_poses: Whether the photos have no poses. The result then has a frame of its own, and
            its poses are aligned with those of the kitchen.
        classes_of: Scene whose result is the truth of the classes, below ``CROP_M``.
    """

    up: tuple[float, float, float] | None = None
    floor_m: float | None = None
    finds_poses: bool = False
    classes_of: str = ""


@dataclass(frozen=True)
class Scene:
    """A capture of the benchmark.

    Attributes:
        name: Name of its folder; frames of one data set have names such as ``nyuv2-0453``.
        prepare: Function of the folder of shared inputs and of an empty working folder that returns
            the path of the capture.
        reference: What is known about the room.
        label_image: NYU40 label image of the only frame, in the folder of shared inputs.
        settings: ``KEY=VALUE`` settings of the reconstruction.
    """

    name: str
    prepare: Prepare
    reference: Reference = Reference()
    label_image: str = ""
    settings: tuple[str, ...] = ()

    @property
    def group(self) -> str:
        """The row of the table to which the scene belongs."""
        return NYU_GROUP if self.label_image else self.name


NYU_GROUP = "nyuv2"


def list_scenes(data: Path, nyu: int) -> list[Scene]:
    """Return the scenes of the benchmark, in the order in which they run.

    Args:
        data: Folder of shared inputs.
        nyu: Number of NYUv2 validation frames.
    """
    known = Reference(KITCHEN_UP, KITCHEN_FLOOR_M)
    low = Reference(KITCHEN_UP, KITCHEN_FLOOR_M, classes_of="kitchen")
    apart = Reference(KITCHEN_UP, KITCHEN_FLOOR_M, finds_poses=True)
    windows = [
        Scene(f"kitchen-{first}-{last - 1}", _kitchen_frames(first, last), known)
        for first, last in KITCHEN_WINDOWS
    ]
    return [
        Scene("kitchen", _in_place(KITCHEN), known),
        *windows,
        Scene("kitchen-low", crop_kitchen, low),
        Scene("kitchen-photos-posed", _kitchen_photos(with_poses=True), known),
        Scene("kitchen-photos", _kitchen_photos(with_poses=False), apart),
        Scene("lounge", _in_place("real_captures/sun3d_lounge")),
        Scene("sunrgbd", _in_place("real_captures/sunrgbd_kv2"), Reference((0, -1, 0))),
        *(
            Scene(f"nyu-{name}".replace("_", "-"), _in_place(f"real_captures/nyu_frames/{name}"))
            for name in ("living", "basement_00000", "basement_00050", "basement_00100")
        ),
        Scene("emsanet-lounge", write_emsanet),
        Scene("flat", _in_place("real_captures/scene0000_cloud"), Reference((0, 0, 1))),
        Scene("library-plan", _in_place("real_captures/roomplan_library")),
        Scene("open3d-living", _in_place("open3d_rgbd_samples/RGBD"), Reference((0, 1, 0))),
        Scene("wash-stand", _in_place("real_captures/scaniverse_bathroom")),
        Scene("realsense-unposed", _in_place("aims_realsense_unposed")),
        Scene("bedroom-photos", _in_place("real_captures/vggt_bedroom")),
        Scene("short-clip", _in_place("real_captures/deepv2d_nyu_0")),
        *(nyu_scene(number) for number in sample_nyu(data / NYU_FOLDER, nyu)),
    ]


def validation_numbers(numbers: Sequence[int]) -> list[int]:
    """Return the numbers of NYUv2 frames that belong to this project's validation split.

    Example:
        >>> validation_numbers(range(190, 260))[:2], validation_numbers(range(190, 260))[-1]
        ([203, 204], 246)
    """
    return [n for n in sorted(numbers) if (n // 50) % 5 == 4 and 3 <= n % 50 < 47]


def sample_nyu(folder: Path, count: int) -> list[int]:
    """Return ``count`` validation frames, evenly spread over all of them."""
    every = validation_numbers([int(path.name[:4]) for path in folder.glob("*.label40.png")])
    count = min(count, len(every))
    return [every[(2 * n + 1) * len(every) // (2 * count)] for n in range(count)]


def _in_place(place: str) -> Prepare:
    return lambda data, folder: data / place


def _kitchen_stems(data: Path) -> list[str]:
    colours = sorted((data / KITCHEN / "frames").glob("*.color.jpg"))
    return [path.name.partition(".")[0] for path in colours]


def _kitchen_frames(first: int, last: int) -> Prepare:
    def prepare(data: Path, folder: Path) -> Path:
        for stem in _kitchen_stems(data)[first:last]:
            for path in (data / KITCHEN / "frames").glob(f"{stem}.*"):
                _copy(path, folder / "frames")
        _copy(data / KITCHEN / "camera-intrinsics.txt", folder)
        return folder

    return prepare


def _kitchen_photos(*, with_poses: bool) -> Prepare:
    def prepare(data: Path, folder: Path) -> Path:
        for stem in _kitchen_stems(data):
            source = data / KITCHEN / "frames"
            if with_poses:
                _copy(source / f"{stem}.color.jpg", folder / "frames")
                _copy(source / f"{stem}.pose.txt", folder / "frames")
            else:
                folder.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source / f"{stem}.color.jpg", folder / f"{stem}.jpg")
        if with_poses:
            _copy(data / KITCHEN / "camera-intrinsics.txt", folder)
        return folder

    return prepare


def kitchen_poses(data: Path) -> dict[str, np.ndarray]:
    """Return the camera-to-world pose of each kitchen frame."""
    frames = data / KITCHEN / "frames"
    return {stem: np.loadtxt(frames / f"{stem}.pose.txt") for stem in _kitchen_stems(data)}


def crop_kitchen(data: Path, folder: Path) -> Path:
    """Write the kitchen without depth more than ``CROP_M`` above the reference floor."""
    prepared = _kitchen_frames(0, len(_kitchen_stems(data)))(data, folder)
    for stem, pose in kitchen_poses(data).items():
        path = prepared / "frames" / f"{stem}.depth.png"
        depth_mm = np.asarray(Image.open(path)).astype(np.uint16)
        cropped = remove_above(
            depth_mm, KITCHEN_CAMERA, pose, np.array(KITCHEN_UP), KITCHEN_FLOOR_M + CROP_M
        )
        Image.fromarray(cropped).save(path)
    return prepared


def remove_above(
    depth_mm: np.ndarray, camera: Camera, pose: np.ndarray, up: np.ndarray, height_m: float
) -> np.ndarray:
    """Return a depth image without the surface above a height.

    Args:
        depth_mm: Depth in millimetres, uint16 [H, W]; 0 and 65535 are missing.
        camera: Intrinsics of the depth camera.
        pose: Camera-to-world transform, 4x4.
        up: Up direction in the world, of any length, float64 [3].
        height_m: Height above the world's origin, in metres.
    """
    depth_m = np.where(depth_mm == 65535, 0, depth_mm).astype(np.float32) / 1000
    points_m, pixels = unproject_depth(depth_m, camera, pose)
    kept = depth_mm.copy().reshape(-1)
    kept[pixels[points_m @ up / np.linalg.norm(up) > height_m]] = 0
    return kept.reshape(depth_mm.shape)


def write_emsanet(data: Path, folder: Path) -> Path:
    """Write the frame of EMSANet as a capture with nominal intrinsics."""
    source = data / "real_captures" / "emsanet_lounge"
    depth_m = np.asarray(Image.open(source / "sample_depth.png")).astype(np.float32) / 1000
    return _write_frame(folder, "lounge", source / "sample_rgb.png", depth_m, AZURE_CAMERA)


def nyu_scene(number: int) -> Scene:
    """Return the scene of one labelled frame of NYUv2, lifted with its depth."""
    name = f"{number:04d}"

    def prepare(data: Path, folder: Path) -> Path:
        source = data / NYU_FOLDER
        steps = np.asarray(Image.open(source / f"{name}.depth8.png")).astype(np.float32)
        colour = source / f"{name}.color.jpg"
        return _write_frame(folder, name, colour, steps * np.float32(NYU_DEPTH_STEP_M), NYU_CAMERA)

    image = f"{NYU_FOLDER}/{name}.label40.png"
    return Scene(f"{NYU_GROUP}-{name}", prepare, label_image=image)


def _write_frame(
    folder: Path, name: str, colour: Path, depth_m: np.ndarray, camera: Camera
) -> Path:
    """Write one frame, whose colour and depth share a camera, with identity pose."""
    pixels = np.asarray(Image.open(colour).convert("RGB"))
    write_plain(folder, [View(name, np.eye(4), pixels, camera, depth_m, camera)])
    return folder


def read_nyu_classes(path: Path) -> np.ndarray:
    """Return the classes of a label image of NYUv2, uint8 [H, W], 255 if unknown."""
    return fold_nyu(np.asarray(Image.open(path)))


def fold_nyu(stored: np.ndarray) -> np.ndarray:
    """Return the classes of stored labels, which are NYU40 ids minus 1, as uint8."""
    from world2minecraft.core.vocabulary import nyu40_classes

    return np.where(stored == NYU_IGNORED, np.uint8(255), nyu40_classes()[stored.astype(int) + 1])


def _copy(path: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, folder / path.name)
