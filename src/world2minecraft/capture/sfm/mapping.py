"""Places from nothing: COLMAP's incremental mapping, on one thread so that it repeats itself."""

from typing import Any

import numpy as np

from world2minecraft.capture.sfm.camera_groups import (
    LONGEST,
    MOST_BENT,
    SHORTEST,
    Lens,
    from_colmap,
    to_colmap,
)
from world2minecraft.capture.sfm.colmap import colmap
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.links import Links
from world2minecraft.capture.sfm.parameters import PosingParameters
from world2minecraft.capture.sfm.progress import Steps
from world2minecraft.core.types import Camera

Model = dict[int, tuple[np.ndarray, Camera]]


def mapped(
    photos: list[Features],
    links: Links,
    lenses: list[Lens],
    parameters: PosingParameters,
    steps: Steps,
) -> list[Model]:
    """Return the models that the links give, the one of most photos first.

    A model maps photo numbers to camera-to-world float64 [4, 4], in a frame of its own, and to the
    camera found. Photos may be in several.
    """
    with colmap() as pycolmap:
        pycolmap.set_random_seed(parameters.seed)
        cache = _cache(pycolmap, photos, links, lenses)
        manager = pycolmap.ReconstructionManager()
        pipeline = pycolmap.IncrementalPipeline(
            _options(pycolmap, lenses, parameters), cache, manager
        )
        placed = [0]

        def told() -> None:  # Python's own turn too: Ctrl-C is seen here.
            placed[0] += 1
            steps.done("places", min(placed[0], len(photos)), len(photos))

        kinds = pycolmap.IncrementalPipelineCallback
        pipeline.add_callback(int(kinds.NEXT_IMAGE_REG_CALLBACK), told)
        pipeline.run()
        models = [_model(manager.get(n)) for n in range(manager.size())]
    return sorted(models, key=lambda model: (-len(model), sorted(model)))


def _cache(pycolmap: Any, photos: list[Features], links: Links, lenses: list[Lens]) -> Any:
    """Return what mapping reads, made in memory: no file and no database."""
    cache = pycolmap.DatabaseCache()
    for number, lens in enumerate(lenses):
        camera = to_colmap(pycolmap, lens.camera, number + 1, simple=lens.known != "stated")
        camera.has_prior_focal_length = lens.known != "unknown"
        cache.add_camera(camera)
        rig = pycolmap.Rig(rig_id=number + 1)
        rig.add_ref_sensor(camera.sensor_id)
        cache.add_rig(rig)
        for i in lens.photos:
            image = pycolmap.Image(
                name=str(i), keypoints=photos[i].pixels, camera_id=number + 1, image_id=i + 1
            )
            frame = pycolmap.Frame(frame_id=i + 1, rig_id=number + 1)
            frame.add_data_id(image.data_id)
            cache.add_frame(frame)
            image.frame_id = i + 1
            cache.add_image(image)
    for (i, j), geometry in links.geometry.items():
        cache.correspondence_graph.add_two_view_geometry(i + 1, j + 1, geometry)
    cache.correspondence_graph.finalize()
    return cache


def _options(pycolmap: Any, lenses: list[Lens], parameters: PosingParameters) -> Any:
    options = pycolmap.IncrementalPipelineOptions()
    for part in (options, options.mapper, options.triangulation):
        part.random_seed = parameters.seed
    options.num_threads = options.mapper.num_threads = 1
    options.extract_colors = False
    options.min_model_size = 3
    options.max_num_models = 10
    options.min_focal_length_ratio, options.max_focal_length_ratio = SHORTEST, LONGEST
    options.max_extra_param = MOST_BENT
    fixed = {number + 1 for number, lens in enumerate(lenses) if lens.is_fixed}
    options.constant_cameras = options.mapper.constant_cameras = fixed
    if fixed:
        options.mapper.abs_pose_refine_focal_length = False
        options.mapper.abs_pose_refine_extra_params = False
    options.ba_global_frames_ratio = options.ba_global_points_ratio = 1.2
    return options


def _model(found: Any) -> Model:
    model: Model = {}
    for image in sorted(found.reg_image_ids()):
        there = np.eye(4)
        there[:3] = found.image(image).cam_from_world().matrix()
        camera = from_colmap(found.camera(found.image(image).camera_id))
        model[image - 1] = np.linalg.inv(there), camera
    return model
