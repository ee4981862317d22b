"""Incremental mapping: estimates poses, cameras and points of photos from their pixels alone.

COLMAP's mapper runs on one thread to be deterministic. Models that share photos are merged if their
poses agree.
"""

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

from world2minecraft.capture.sfm.bundle_adjustment import (
    MIN_POINTS,
    SparseModel,
    triangulate_and_adjust,
)
from world2minecraft.capture.sfm.camera_groups import (
    MAX_DISTORTION,
    MAX_FOCAL,
    MIN_FOCAL,
    CameraGroup,
    camera_by_photo,
    default_camera,
    from_colmap,
    group_cameras,
    is_plausible_camera,
    to_colmap,
)
from world2minecraft.capture.sfm.features import Features, extract_features
from world2minecraft.capture.sfm.matching import MatchGraph, match_photos
from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.capture.sfm.pycolmap_access import pycolmap_session
from world2minecraft.capture.sfm.results import (
    check_enough,
    explain_left_out,
    median_depth,
    no_model_error,
    panoramas_error,
    to_sparse_scene,
    too_few_error,
)
from world2minecraft.capture.sfm.rigs import count_places, make_rigs, places_of
from world2minecraft.capture.sfm.similarity_transform import Similarity, align_similarity
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera, SparseScene
from world2minecraft.core.types.photos import PhotoStream

Model = dict[int, tuple[np.ndarray, Camera]]
MIN_SHARED_PHOTOS = 3  # Two photos fit any two models.
MAX_ROTATION_DEG = 3.0  # Maximum rotation of shared photos after the best similarity.
MAX_SHIFT_SHARE = 0.05  # Their maximum shift / distance of the farthest of them.
MEDIAN_DEPTH = 2.5  # Typical depth in rooms in metres, which sets the initial scale.
OTHER_FOCALS = (0.5, 1.2)  # Focal lengths / longer side of wide lenses of phones and of long ones.
ENOUGH_SHARE = 0.6  # A model of this share of the linked photos needs no second trial.
MIN_PLACED_SHARE = 0.25  # Fewer photos show no room; 6 of 40 photos of bare walls gave a wrong one.
MIN_PHOTOS = 3


def run_mapper(
    photos: list[Features],
    links: MatchGraph,
    groups: list[CameraGroup],
    parameters: SfmParameters,
    steps: ProgressSteps,
) -> list[Model]:
    """Run the incremental mapper, and return its models with the largest first.

    A model maps photo numbers to the camera-to-world matrix, float64 [4, 4] in the model's own
    frame, and to the estimated camera. A photo may be part of several models.
    """
    with pycolmap_session() as pycolmap:
        pycolmap.set_random_seed(parameters.seed)
        cache = _database_cache(pycolmap, photos, links, groups)
        manager = pycolmap.ReconstructionManager()
        pipeline = pycolmap.IncrementalPipeline(
            _options(pycolmap, groups, parameters), cache, manager
        )
        placed = [0]

        def on_photo_placed() -> None:  # Python's own turn too: Ctrl-C is seen here.
            placed[0] += 1
            steps.done("places", min(placed[0], len(photos)), len(photos))

        kinds = pycolmap.IncrementalPipelineCallback
        pipeline.add_callback(int(kinds.NEXT_IMAGE_REG_CALLBACK), on_photo_placed)
        pipeline.run()
        models = [_read_model(manager.get(n)) for n in range(manager.size())]
    return sorted(models, key=lambda model: (-len(model), sorted(model)))


def _database_cache(
    pycolmap: Any, photos: list[Features], links: MatchGraph, groups: list[CameraGroup]
) -> Any:
    """Return the input of the mapper, created in memory without a database file."""
    cache = pycolmap.DatabaseCache()
    cameras = []
    for number, group in enumerate(groups):
        simple = group.known not in ("stated", "exact")
        camera = to_colmap(pycolmap, group.camera, number + 1, simple=simple)
        camera.has_prior_focal_length = group.known != "unknown"
        cache.add_camera(camera)
        cameras.append(camera)
    rigs, rig_of_photo = make_rigs(pycolmap, photos, groups, cameras)
    for rig in rigs:
        cache.add_rig(rig)
    images: dict[int, list] = {}
    places = places_of(photos)
    for number, group in enumerate(groups):
        for i in group.photos:
            image = pycolmap.Image(
                name=str(i), keypoints=photos[i].pixels, camera_id=number + 1, image_id=i + 1
            )
            image.frame_id = places[i] + 1
            images.setdefault(places[i], []).append(image)
    for place, members in sorted(images.items()):
        rig_id = rig_of_photo[members[0].image_id - 1]
        frame = pycolmap.Frame(frame_id=place + 1, rig_id=rig_id)
        for image in members:
            frame.add_data_id(image.data_id)
        cache.add_frame(frame)
        for image in members:
            cache.add_image(image)
    for (i, j), geometry in links.geometry.items():
        cache.correspondence_graph.add_two_view_geometry(i + 1, j + 1, geometry)
    cache.correspondence_graph.finalize()
    return cache


def _options(pycolmap: Any, groups: list[CameraGroup], parameters: SfmParameters) -> Any:
    options = pycolmap.IncrementalPipelineOptions()
    for part in (options, options.mapper, options.triangulation):
        part.random_seed = parameters.seed
    options.num_threads = options.mapper.num_threads = 1
    options.extract_colors = False
    options.min_model_size = 3
    options.max_num_models = 10
    options.min_focal_length_ratio, options.max_focal_length_ratio = MIN_FOCAL, MAX_FOCAL
    options.max_extra_param = MAX_DISTORTION
    fixed = {number + 1 for number, group in enumerate(groups) if group.is_fixed}
    options.constant_cameras = options.mapper.constant_cameras = fixed
    if fixed:
        options.mapper.abs_pose_refine_focal_length = False
        options.mapper.abs_pose_refine_extra_params = False
    options.ba_global_frames_ratio = options.ba_global_points_ratio = 1.2
    return options


def _read_model(found: Any) -> Model:
    model: Model = {}
    for image in sorted(found.reg_image_ids()):
        there = np.eye(4)
        there[:3] = found.image(image).cam_from_world().matrix()
        camera = from_colmap(found.camera(found.image(image).camera_id))
        model[image - 1] = np.linalg.inv(there), camera
    return model


def merge_models(models: list[Model]) -> tuple[Model, int]:
    """Merge models into the largest one, and return it with the number of merged models.

    Args:
        models: Models of ``run_mapper``, the largest first.
    """
    whole = dict(models[0])
    waiting, count = list(models[1:]), 0
    while True:
        fitting = next((one for one in waiting if _register_model(one, whole) is not None), None)
        if fitting is None:
            return whole, count
        carried = _register_model(fitting, whole) or {}
        whole = {**carried, **whole}
        waiting.remove(fitting)
        count += 1


def _register_model(model: Model, whole: Model) -> Model | None:
    """Return the photos of a model in the frame of the merged model, or None if it does not fit."""
    shared = sorted(set(model) & set(whole))
    if len(shared) < MIN_SHARED_PHOTOS or len(shared) == len(model):
        return None
    given = np.array([model[i][0] for i in shared])
    wanted = np.array([whole[i][0] for i in shared])
    try:
        found = align_similarity(given, wanted)
    except ValueError:
        return None
    way = float(np.linalg.norm(np.ptp(wanted[:, :3, 3], axis=0)))
    if (
        np.median(found.off_deg) > MAX_ROTATION_DEG
        or np.median(found.off_m) > MAX_SHIFT_SHARE * way
    ):
        return None
    names = sorted(model)
    poses = found.poses(np.array([model[i][0] for i in names]))
    return {i: (pose, model[i][1]) for i, pose in zip(names, poses, strict=True)}


def find_poses(
    photos: PhotoStream,
    parameters: SfmParameters | None = None,
    progress: Progress = no_progress,
) -> SparseScene:
    """Estimate the camera poses of photos from their pixels alone.

    The result has an arbitrary frame, and a scale at which the median depth is 2.5. Cameras stated
    by the photos are the initial values of the intrinsics.

    Raises:
        CaptureError: If there are too few photos or their poses cannot be estimated.
        MissingExtraError: If pycolmap is not installed.
    """
    chosen = parameters or SfmParameters()
    count = len(photos)
    steps = ProgressSteps(
        progress, {"features": count, "alike": 9, "matches": 9, "places": count + 1}
    )
    features = extract_features(photos, chosen, steps)
    check_enough(features, MIN_PHOTOS)
    groups = group_cameras(features)
    links = match_photos(features, groups, chosen, steps)
    try:
        found, notes, models = map_from_scratch(features, groups, links, chosen, steps)
        if len(found.poses) < MIN_PLACED_SHARE * len(features):
            raise too_few_error(len(found.poses), len(features))
    except CaptureError as error:
        if panoramas := count_places(features):
            raise panoramas_error(panoramas) from error
        raise
    steps.end()
    change = Similarity(
        MEDIAN_DEPTH / median_depth(found), np.eye(3), np.zeros(3), np.zeros(0), np.zeros(0)
    )
    out = explain_left_out(features, found.poses, links)
    if len(found.poses) < ENOUGH_SHARE * len(features):
        notes.append(f"poses were found for only {len(found.poses)} of {len(features)} photos")
    return to_sparse_scene(
        features,
        found,
        change,
        left_out=tuple(out),
        notes=tuple(notes),
        facts={"models": models, **focal_facts(features, found, groups)},
    )


def map_from_scratch(
    photos: list[Features],
    groups: list[CameraGroup],
    links: MatchGraph,
    parameters: SfmParameters,
    steps: ProgressSteps,
) -> tuple[SparseModel, list[str], int]:
    """Estimate the poses of photos from their matches alone.

    Returns:
        The model, notes, and the number of models found by the mapper.

    Raises:
        CaptureError: If no model of at least three photos was found.
    """
    models, groups = _best_trial(photos, groups, links, parameters, steps)
    if not models or len(models[0]) < MIN_PHOTOS:
        raise no_model_error(photos, links, camera_by_photo(groups))
    whole, count = merge_models(models)
    notes = [f"{count + 1} groups of photos were merged by the photos they share"] if count else []
    poses = {i: pose for i, (pose, _) in sorted(whole.items())}
    cameras = {i: camera for i, (_, camera) in whole.items()}
    gates = parameters.gates_px[-2:] if count else parameters.gates_px[-1:]
    found = refine_poses(photos, links, poses, replace_cameras(groups, cameras), gates, parameters)
    if len(found.poses) < MIN_PHOTOS or len(found.points) < MIN_POINTS:
        raise no_model_error(photos, links, camera_by_photo(groups))
    if any(group.known == "assumed" for group in groups):
        notes.append("the photos do not determine the focal length; using a typical value")
    return found, notes, len(models)


def _best_trial(
    photos: list[Features],
    groups: list[CameraGroup],
    links: MatchGraph,
    parameters: SfmParameters,
    steps: ProgressSteps,
) -> tuple[list[Model], list[CameraGroup]]:
    """Return the models and the initial cameras of the best trial.

    If intrinsics are unknown and the defaults do not lead to a model, fixed defaults are tried, and
    then other focal lengths.
    """
    linked = {i for pair in links.matches for i in pair}
    best: tuple[list[Model], list[CameraGroup]] = ([], groups)
    if len(linked) < MIN_PHOTOS:
        return best
    for trial in _initial_cameras(groups):
        models = [
            model
            for model in run_mapper(photos, links, trial, parameters, steps)
            if all(is_plausible_camera(camera) for _, camera in model.values())
        ]
        if models and len(models[0]) > sum(len(model) for model in best[0][:1]):
            best = models, trial
        if best[0] and len(best[0][0]) >= ENOUGH_SHARE * len(linked):
            break
    return best


def _initial_cameras(groups: list[CameraGroup]) -> list[list[CameraGroup]]:
    """Return the initial cameras of each trial."""
    if all(group.known == "exact" for group in groups):
        return [groups]
    fixed = [replace(group, known="assumed") for group in groups]
    others = [[_with_focal(group, focal) for group in groups] for focal in OTHER_FOCALS]
    return [groups, fixed, *(others if any(group.known == "unknown" for group in groups) else [])]


def _with_focal(group: CameraGroup, focal: float) -> CameraGroup:
    if group.known != "unknown":
        return group
    size = group.camera.width_px, group.camera.height_px
    return replace(group, camera=default_camera(*size, focal))


def refine_poses(
    photos: list[Features],
    links: MatchGraph,
    poses: dict[int, np.ndarray],
    groups: list[CameraGroup],
    gates_px: tuple[float, ...],
    parameters: SfmParameters,
    stated: dict[int, np.ndarray] | None = None,
) -> SparseModel:
    """Refine poses and intrinsics in one round per gate, and remove photos with too few points."""
    found = None
    for gate in gates_px:
        last = gate == gates_px[-1]
        found = triangulate_and_adjust(
            photos, links, poses, groups, gate, parameters,
            tolerance=1e-5 if last else 1e-3, stated=stated,
        )  # fmt: skip
        poses = _well_placed(photos, found)
        groups = replace_cameras(groups, found.cameras)
        if last and len(poses) < len(found.poses):
            found = triangulate_and_adjust(
                photos, links, poses, groups, gate, parameters, tolerance=1e-5, stated=stated
            )
    if found is None:
        raise ValueError("gates_px must not be empty")
    return found


def _well_placed(photos: list[Features], found: SparseModel) -> dict[int, np.ndarray]:
    """Return the poses of the photos whose place observes enough points."""
    places, seen = places_of(photos), Counter[int]()
    for i in found.poses:
        seen[places[i]] += found.seen_by(i)
    return {i: pose for i, pose in found.poses.items() if seen[places[i]] >= MIN_POINTS}


def replace_cameras(groups: list[CameraGroup], cameras: dict) -> list[CameraGroup]:
    """Return the camera groups with the estimated cameras of their photos."""
    return [
        replace(
            group, camera=next((cameras[i] for i in group.photos if i in cameras), group.camera)
        )
        for group in groups
    ]


def focal_facts(photos: list[Features], found: SparseModel, groups: list[CameraGroup]) -> dict:
    """Return the given and the estimated focal length of the largest camera group, in pixels."""
    main = max(groups, key=lambda group: sum(i in found.poses for i in group.photos))
    placed = next((i for i in main.photos if i in found.poses), None)
    return {
        "lenses": len(groups),
        "focal_given": main.known,
        "focal_given_px": None if main.known == "unknown" else round(main.camera.fx_px, 2),
        "focal_found_px": None if placed is None else round(found.cameras[placed].fx_px, 2),
    }
