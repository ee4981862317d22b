"""Several models become one, where they share photos and agree on how these stand."""

import numpy as np

from world2minecraft.capture.sfm.mapping import Model
from world2minecraft.capture.sfm.similarity_transform import align_similarity

LEAST_SHARED = 3  # Two photos fit any two models.
MOST_DEG = 3.0  # How far shared photos may be turned after the best similarity,
MOST_SHARE = 0.05  # and moved, by the way between the farthest of them.


def joined(models: list[Model]) -> tuple[Model, int]:
    """Return the largest model with those joined to it that fit, and how many these were.

    Args:
        models: as mapping gives them, the largest first.
    """
    whole = dict(models[0])
    waiting, count = list(models[1:]), 0
    while True:
        fitting = next((one for one in waiting if _carried(one, whole) is not None), None)
        if fitting is None:
            return whole, count
        carried = _carried(fitting, whole) or {}
        whole = {**carried, **whole}
        waiting.remove(fitting)
        count += 1


def _carried(model: Model, whole: Model) -> Model | None:
    """Return the photos of a model in the frame of the whole, or None where it does not fit."""
    shared = sorted(set(model) & set(whole))
    if len(shared) < LEAST_SHARED or len(shared) == len(model):
        return None
    given = np.array([model[i][0] for i in shared])
    wanted = np.array([whole[i][0] for i in shared])
    try:
        found = align_similarity(given, wanted)
    except ValueError:
        return None
    way = float(np.linalg.norm(np.ptp(wanted[:, :3, 3], axis=0)))
    if np.median(found.off_deg) > MOST_DEG or np.median(found.off_m) > MOST_SHARE * way:
        return None
    names = sorted(model)
    poses = found.poses(np.array([model[i][0] for i in names]))
    return {i: (pose, model[i][1]) for i, pose in zip(names, poses, strict=True)}
