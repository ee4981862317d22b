"""Reader of NYU Depth v2 raw data: ``r-*.ppm``, ``d-*.pgm`` and ``a-*.dump`` files without poses.

File names have the form ``r-SECONDS-TICKS.ppm``. Depth images contain Kinect disparities with
swapped bytes, neither registered nor undistorted. The intrinsics and the transform between the two
cameras are those of the data set's toolbox. The toolbox stores the rotation with all signs
inverted, which its projection code corrects; here, the signs are correct, and the colour lens is
2.5 cm to the right of the depth lens.
"""

import re

import numpy as np

from world2minecraft.capture.readers.datasets.intrinsics import VGA, stated_camera
from world2minecraft.capture.readers.datasets.time_sync import pair_times
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError

WITHIN_S = 0.05  # Both streams drop frames; a hand moves by a centimetre or two in that time.
# fx fy cx cy and k1 k2 p1 p2 k3 of both lenses, then depth to colour: the data set's toolbox.
COLOUR = (
    (518.85790117450188, 519.46961112127485, 325.58244941119034, 253.73616633400465),
    (0.20796615318809061, -0.58613825163911781, 7.2231363135888329e-04, 1.0479627195765181e-03,
     0.49856986684705107),
)  # fmt: skip
DEPTH = (
    (582.62448167737955, 582.69103270988637, 313.04475870804731, 238.44389626620386),
    (-9.9897236553084481e-02, 0.39065324602765344, 1.9290592870229277e-03,
     -1.9422022475975055e-03, -0.51031725053400578),
)  # fmt: skip
ROTATION = (
    (9.9997798940829263e-01, -5.0359919480810989e-03, -4.3196624923060242e-03),
    (5.0518419386157446e-03, 9.9998051861143999e-01, 3.6662365748484798e-03),
    (4.3011152014118693e-03, -3.6879781309514218e-03, 9.9998394948385538e-01),
)
SHIFT_M = (-2.5031875059141302e-02, 2.9342312935846411e-04, -6.6238747008330102e-04)
_NAME = re.compile(r"[rd]-(\d{1,12}(?:\.\d{1,9})?)(?:-\d{1,12})?\.(?:ppm|pgm)", re.ASCII)


class NyuRawSource:
    """A reader of scenes in the raw data of NYU Depth v2."""

    layout = "r-*.ppm and d-*.pgm (NYU depth v2, raw)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains both colour and depth images with NYU names."""
        return all(
            any(_NAME.fullmatch(path.name) for path in folder.glob(pattern))
            for pattern in ("r-*.ppm", "d-*.pgm")
        )

    def read(self, folder: AnyPath) -> Capture:
        """Read the pairs of colour and depth images, matched by time.

        Raises:
            CaptureError: If no colour and depth images match in time.
        """
        colour_s, colours = _stream(folder, "r-*.ppm")
        depth_s, depths = _stream(folder, "d-*.pgm")
        pairs = pair_times(colour_s, depth_s, WITHIN_S)
        if not pairs:
            raise CaptureError(
                folder,
                f"no r-*.ppm and d-*.pgm images are within {WITHIN_S} s of each other; "
                "copy all files of one scene",
            )
        colour_camera = stated_camera(folder, VGA, *COLOUR)
        depth_camera = stated_camera(folder, VGA, *DEPTH)
        depth_to_colour = _depth_to_colour()
        frames = tuple(
            FrameFiles(
                colours[index].stem,
                None,
                colours[index],
                colour_camera,
                depths[other],
                depth_camera,
                depth_to_colour,
                time_s=float(colour_s[index]),
            )
            for index, other in pairs
        )
        note = "using the intrinsics published with NYU Depth v2"
        return Capture(folder, "nyu_raw", frames, depth_unit="nyu_raw", notes=(note,))


def _stream(folder: AnyPath, pattern: str) -> tuple[np.ndarray, list[AnyPath]]:
    """Return the times and files of one stream, sorted by time."""
    found = [
        (float(match[1]), path)
        for path in folder.glob(pattern)
        if (match := _NAME.fullmatch(path.name))
    ]
    found.sort(key=lambda item: (item[0], item[1].name))
    return np.array([seconds for seconds, _ in found]), [path for _, path in found]


def _depth_to_colour() -> np.ndarray:
    """Return the 4x4 transform from depth to colour camera, with an orthonormal rotation."""
    left, _, right = np.linalg.svd(np.array(ROTATION))
    transform = np.eye(4)
    transform[:3, :3] = left @ right
    transform[:3, 3] = SHIFT_M
    return transform
