"""The report shows views with many things, spread over the frames."""

from types import SimpleNamespace

import numpy as np

from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import block_to_room, look_at
from world2minecraft.core.types import AIR, BlockVolume, Camera, Scan
from world2minecraft.evaluation.report.comparison_pictures import PAIRS, choose_views
from world2minecraft.reconstruction.registration.corrected_scan import CorrectedViews
from world2minecraft.rendering import prepare_scene

CAMERA = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)


def volume_with_a_thing() -> BlockVolume:
    """A block of a thing in the middle of a floor of stone, a metre a block."""
    states, semantic = np.zeros((2, 9, 5, 9), np.uint16)
    states[:, 0], semantic[:, 0] = 1, SemanticClass.FLOOR
    states[4, 1, 4], semantic[4, 1, 4] = 1, SemanticClass.FURN
    instance = np.zeros(states.shape, np.uint16)
    instance[4, 1, 4] = 1
    palette = (AIR, "minecraft:stone")
    place = ((0, 0, 0), block_to_room(np.zeros(2), 1.0))
    return BlockVolume(states, palette, semantic.astype(np.uint8), instance, *place)


def test_of_each_sixth_a_view_of_things_is_shown():
    volume = volume_with_a_thing()
    thing = (volume.block_to_room @ [4.5, 1.5, 4.5, 1])[:3]
    at_it = look_at(thing + np.array([2.0, 1.0, 1.5]), thing)
    away = look_at(thing + np.array([2.0, 1.0, 1.5]), thing + np.array([4.0, 2.0, 3.0]))
    frames = tuple(
        FrameFiles(f"f{n:02d}", camera_to_world=at_it if n % 3 == 1 else away, colour_camera=CAMERA)
        for n in range(3 * PAIRS)
    )
    names = tuple(frame.name for frame in frames)
    shown = [names[n] for n in range(1, len(names), 3)]
    views = SimpleNamespace(frames=frames)
    scan = Scan(views, np.eye(4), np.ones(3), names)  # type: ignore[arg-type]
    scene = prepare_scene(volume)
    assert choose_views(scan, scene) == shown
    swap = at_it @ np.linalg.inv(away)
    changes = {name: (swap if n % 3 == 0 else np.eye(4), 1.0) for n, name in enumerate(names)}
    changes |= {name: (away @ np.linalg.inv(at_it), 1.0) for name in shown}
    moved = Scan(CorrectedViews(views, changes), np.eye(4), np.ones(3), names)  # type: ignore[arg-type]
    assert choose_views(moved, scene) == list(names[::3])


def test_without_frames_the_views_are_evenly_spread():
    names = tuple(map(str, range(12)))
    scan = Scan((), np.eye(4), np.ones(3), names)
    assert len(choose_views(scan, None)) == PAIRS  # type: ignore[arg-type]
