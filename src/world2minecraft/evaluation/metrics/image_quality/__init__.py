"""Quality of a single picture without a reference: NIQE, PIQE and the variance of its Laplacian.

All take uint8 pictures, [H, W] or [H, W, 3] in sRGB, and return one number. None knows rendered
pictures: NIQE and PIQE are models of photographs, and the Laplacian counts the edges of blocks as
sharpness.
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
