"""Triangulation and bundle adjustment with pycolmap.

One round triangulates points from all matches that agree within a distance (the gate), adjusts
poses, cameras and points together, and removes observations with larger errors.

Anchors stabilise photos that have stated poses but show too little texture. Each photo observes
eight virtual points, which are fixed at the positions that its stated pose implies. Because of the
robust loss, many consistent real points outweigh the anchors. On a generated room with bare walls,
refinement without anchors moved good poses by 70 mm. Anchors also constrain the intrinsics, so they
are used only for captures with too little texture to estimate them.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.sfm.camera_groups import (
    CameraGroup,
    camera_by_photo,
    from_colmap,
    normalise_pixels,
    to_colmap,
)
from world2minecraft.capture.sfm.features import Features, pixel_unit
from world2minecraft.capture.sfm.matching import MatchGraph
from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.pycolmap_access import pycolmap_session
from world2minecraft.capture.sfm.rigs import make_rigs, places_of, rig_pose, to_rigid
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import project

CORNERS = ((0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.8, 0.8))  # Positions of the anchors in the image.
DEPTHS = (0.6, 1.6)  # / median depth: near anchors fix the position, far ones the rotation.
ANCHORS = 2 * len(CORNERS) * len(DEPTHS)  # Each is observed twice, as COLMAP requires.
MIN_ANGLE_DEG = 1.5  # Rays that meet at a smaller angle do not determine a depth.
MIN_POINTS = 20  # Fewer points do not constrain a photo.
MIN_PHOTOS_FOR_RADIAL = 15  # From here on, a second term of radial distortion is estimated.


def anchor_pixels(camera: Camera) -> np.ndarray:
    """Return the pixels at which a photo observes its anchors, float64 [16, 2]."""
    corners = np.array(CORNERS) * [camera.width_px, camera.height_px]
    return np.concatenate([corners] * (ANCHORS // len(corners)))


def anchor_points(camera: Camera, pose: np.ndarray, depth: float) -> np.ndarray:
    """Return the anchors of a photo with a stated pose for a median depth, float64 [8, 3]."""
    rays = normalise_pixels(camera, anchor_pixels(camera)[: ANCHORS // 2])
    local = np.concatenate([rays, np.ones((len(rays), 1))], axis=1)
    local *= depth * np.repeat(DEPTHS, len(CORNERS))[:, None]
    return local @ pose[:3, :3].T + pose[:3, 3]


def add_anchors(
    pycolmap: Any, model: Any, stated: dict[int, np.ndarray], cameras: dict[int, Camera]
) -> list[int]:
    """Add the anchors of stated poses to a model, and return their point ids.

    The features of each image in the model must end with those of the anchors.
    """
    inside = [i for i in sorted(stated) if model.exists_image(i + 1)]
    if not inside or not model.num_points3D():
        return []
    depth = _median_depth(model, inside)
    added = []
    for i in inside:
        first = model.image(i + 1).num_points2D() - ANCHORS
        for n, point in enumerate(anchor_points(cameras[i], stated[i], depth)):
            track = pycolmap.Track()
            track.add_element(i + 1, first + n)
            track.add_element(i + 1, first + n + ANCHORS // 2)
            added.append(model.add_point3D(point, track, np.zeros(3, np.uint8)))
    return added


def _median_depth(model: Any, inside: list[int]) -> float:
    points = np.array([model.point3D(n).xyz for n in sorted(model.point3D_ids())])
    depths = []
    for i in inside:
        matrix = model.image(i + 1).cam_from_world().matrix()
        seen = points @ matrix[2, :3] + matrix[2, 3]
        depths.append(seen[seen > 0])
    return float(np.median(np.concatenate(depths)))


@dataclass(frozen=True, eq=False)
class SparseModel:
    """Camera poses with triangulated points.

    Observation t is point ``track_point[t]`` in photo ``track_photo[t]`` at feature
    ``track_feature[t]``, with a reprojection error of ``error_px[t]``.

    Attributes:
        poses: Camera-to-world matrices, float64 [4, 4], by photo number.
        cameras: Intrinsics by photo number.
        points: Point positions, float64 [P, 3].
        track_point: Point index of each observation.
        track_photo: Photo number of each observation.
        track_feature: Feature index of each observation.
        error_px: Reprojection error of each observation in pixels.
    """

    poses: dict[int, np.ndarray]
    cameras: dict[int, Camera]
    points: np.ndarray
    track_point: np.ndarray
    track_photo: np.ndarray
    track_feature: np.ndarray
    error_px: np.ndarray

    def seen_by(self, photo: int) -> int:
        """Return the number of points that a photo observes."""
        return int((self.track_photo == photo).sum())

    @property
    def median_px(self) -> float:
        """The median reprojection error in pixels, or infinity without observations."""
        return float(np.median(self.error_px)) if len(self.error_px) else float("inf")


def triangulate_and_adjust(
    photos: list[Features],
    links: MatchGraph,
    poses: dict[int, np.ndarray],
    groups: list[CameraGroup],
    gate_px: float,
    parameters: SfmParameters,
    free: bool = True,
    tolerance: float = 1e-6,
    stated: dict[int, np.ndarray] | None = None,
) -> SparseModel:
    """Triangulate points for photos with poses, and optionally refine poses and intrinsics.

    Args:
        photos: Features of all photos.
        links: Verified matches between photos.
        poses: Camera-to-world matrices by photo number.
        groups: Shared cameras; they are unchanged if ``free`` is False.
        gate_px: Maximum reprojection error of an observation, in pixels of an image 640 pixels
            wide.
        parameters: Parameters such as the seed.
        free: Whether to refine poses and intrinsics as well as points.
        tolerance: Relative improvement per step at which the adjustment stops.
        stated: Stated poses by photo number that act as anchors.
    """
    unit = pixel_unit(photos)
    gate_px = gate_px * unit
    with pycolmap_session() as pycolmap:
        model = _build_model(pycolmap, photos, poses, groups, free)
        graph = _build_graph(pycolmap, photos, links, poses)
        manager = pycolmap.ObservationManager(model, graph)
        _triangulate(pycolmap, model, graph, manager, gate_px, parameters)
        manager.filter_all_points3D(gate_px, MIN_ANGLE_DEG)
        if model.num_points3D():
            options = _adjustment_options(pycolmap, free, unit, tolerance)
            fixed = [n + 1 for n, group in enumerate(groups) if group.is_fixed or not free]
            anchors = (
                add_anchors(pycolmap, model, stated or {}, camera_by_photo(groups)) if free else []
            )
            _adjust(pycolmap, model, options, fixed, anchors)
            manager.filter_all_points3D(gate_px, MIN_ANGLE_DEG)
        return _read_model(photos, model, poses)


def _build_model(
    pycolmap: Any, photos: list[Features], poses: dict, groups: list[CameraGroup], free: bool
):
    model = pycolmap.Reconstruction()
    cameras, placed_photos = [], []
    for number, group in enumerate(groups):
        placed = [i for i in group.photos if i in poses]
        simple = (
            free and len(placed) < MIN_PHOTOS_FOR_RADIAL and not any(group.camera.distortion[1:])
        )
        camera = to_colmap(pycolmap, group.camera, number + 1, simple)
        model.add_camera(camera)
        cameras.append(camera)
        for i in placed:
            pixels = np.concatenate([photos[i].pixels, anchor_pixels(group.camera)])
            image = pycolmap.Image(
                name=str(i), keypoints=pixels, camera_id=number + 1, image_id=i + 1
            )
            placed_photos.append((i, image))
    rigs, rig_of_photo = make_rigs(pycolmap, photos, groups, cameras)
    for rig in rigs:
        model.add_rig(rig)
    places, members = places_of(photos), {}
    for i, image in placed_photos:
        members.setdefault(places[i], []).append((i, image))
    for place, images in members.items():
        first = images[0][0]
        frame = pycolmap.Frame(frame_id=place + 1, rig_id=rig_of_photo[first])
        for _, image in images:
            image.frame_id = frame.frame_id
            frame.add_data_id(image.data_id)
        frame.rig_from_world = to_rigid(pycolmap, rig_pose(photos[first], poses[first]))
        model.add_frame(frame)
        for _, image in images:
            model.add_image(image)
        model.register_frame(frame.frame_id)
    return model


def _build_graph(pycolmap: Any, photos: list[Features], links: MatchGraph, poses: dict) -> Any:
    graph = pycolmap.CorrespondenceGraph()
    for i in sorted(poses):
        graph.add_image(i + 1, len(photos[i].pixels) + ANCHORS)
    for (i, j), geometry in links.geometry.items():
        if i in poses and j in poses:
            graph.add_two_view_geometry(i + 1, j + 1, geometry)
    graph.finalize()
    return graph


def _triangulate(
    pycolmap: Any, model: Any, graph: Any, manager: Any, gate_px: float, parameters: Any
) -> None:
    focal = min(camera.mean_focal_length() for camera in model.cameras.values())
    options = pycolmap.IncrementalTriangulatorOptions()
    options.random_seed = parameters.seed
    options.min_angle = MIN_ANGLE_DEG
    angle = float(np.degrees(max(gate_px, 4.0) / focal))
    options.create_max_angle_error = options.continue_max_angle_error = 1.5 * angle
    options.merge_max_reproj_error = options.complete_max_reproj_error = gate_px
    triangulator = pycolmap.IncrementalTriangulator(graph, model, manager)
    for image in sorted(model.reg_image_ids()):
        triangulator.triangulate_image(options, image)
    triangulator.complete_all_tracks(options)
    triangulator.merge_all_tracks(options)


def _adjustment_options(pycolmap: Any, free: bool, unit: float, tolerance: float) -> Any:
    options = pycolmap.BundleAdjustmentOptions()
    options.print_summary = False
    options.refine_rig_from_world = free
    options.refine_sensor_from_rig = False
    options.ceres.loss_function_type = pycolmap.LossFunctionType.CAUCHY
    options.ceres.loss_function_scale = unit
    options.ceres.solver_options.num_threads = 1  # Sums in another order are other sums.
    options.ceres.solver_options.max_num_iterations = 50
    options.ceres.solver_options.function_tolerance = tolerance
    return options


def _adjust(pycolmap: Any, model: Any, options: Any, fixed: list[int], anchors: list[int]) -> None:
    """Run the bundle adjustment with the listed cameras and points fixed."""
    config = pycolmap.BundleAdjustmentConfig()
    for image in sorted(model.reg_image_ids()):
        config.add_image(image)
    for camera in fixed:
        config.set_constant_cam_intrinsics(camera)
    for point in anchors:
        config.add_constant_point(point)
    if not anchors:
        config.fix_gauge(pycolmap.BundleAdjustmentGauge.TWO_CAMS_FROM_WORLD)
    pycolmap.create_default_bundle_adjuster(options, config, model).solve()
    for point in anchors:
        model.delete_point3D(point)


def _read_model(photos: list[Features], model: Any, poses: dict[int, np.ndarray]) -> SparseModel:
    cameras = {i: from_colmap(model.camera(model.image(i + 1).camera_id)) for i in sorted(poses)}
    found = {}
    for i in poses:
        there = np.eye(4)
        there[:3] = model.image(i + 1).cam_from_world().matrix()
        found[i] = np.linalg.inv(there)
    points, track = [], []
    for number, point in enumerate(sorted(model.point3D_ids())):
        one = model.point3D(point)
        points.append(one.xyz)
        track += [(number, e.image_id - 1, e.point2D_idx) for e in one.track.elements]
    rows = np.array(sorted(track), np.int64).reshape(-1, 3)
    every = np.array(points, np.float64).reshape(-1, 3)
    errors = _reprojection_errors(photos, found, cameras, every, rows)
    return SparseModel(found, cameras, every, rows[:, 0], rows[:, 1], rows[:, 2], errors)


def _reprojection_errors(
    photos: list[Features], poses: dict, cameras: dict, points, rows
) -> np.ndarray:
    """Return the reprojection error of each observation in pixels."""
    errors = np.zeros(len(rows))
    for i, pose in poses.items():
        mine = rows[:, 1] == i
        world_to_camera = np.linalg.inv(pose)
        local = points[rows[mine, 0]] @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
        off = project(local, cameras[i]) - photos[i].pixels[rows[mine, 2]]
        errors[mine] = np.linalg.norm(off, axis=1)
    return errors
