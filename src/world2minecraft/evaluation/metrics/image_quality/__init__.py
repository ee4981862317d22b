"""No-reference image quality: NIQE, PIQE and the variance of the Laplacian.

All functions accept uint8 images, [H, W] or [H, W, 3] in sRGB, and return one number. None of them
was designed for rendered images: NIQE and PIQE are models of photographs, and the Laplacian counts
the edges of blocks as sharpness.
"""

from world2minecraft.evaluation.metrics.image_quality.laplacian import laplacian, laplacian_variance
from world2minecraft.evaluation.metrics.image_quality.niqe import NiqeModel, niqe, niqe_model
from world2minecraft.evaluation.metrics.image_quality.piqe import piqe
from world2minecraft.evaluation.metrics.image_quality.scene_statistics import to_grey

__all__ = [
    "NiqeModel",
    "laplacian",
    "laplacian_variance",
    "niqe",
    "niqe_model",
    "piqe",
    "to_grey",
]
