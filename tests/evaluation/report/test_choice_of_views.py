"""The report shows views with many things, spread over the frames."""

from types import SimpleNamespace

import numpy as np

from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, Scan
from world2minecraft.evaluation.report.comparison_pictures import PAIRS, choose_views
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.reconstruction.registration.corrected_scan import CorrectedViews
from world2minecraft.rendering import prepare_scene

CAMERA = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)


def test_of_each_sixth_a_view_of_things_is_shown():
    volume = generate_world(11, rooms=3, storeys=1).volume
    cells = np.argwhere(volume.instance > 0)[0] + np.array(volume.corner) + 0.5
    thing = (volume.block_to_room @ [*cells, 1])[:3]
    at_it, away = look_at(thing + np.array([0.6, 0.4, 0.3]), thing), np.eye(4)
    away[:3, 3] = thing + np.array([0, 0, 60])
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
