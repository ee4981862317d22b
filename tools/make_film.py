"""Make the film of the README: a generated room from photos to a walk in the evening.

    python tools/make_film.py RUN docs/images/demo.webp

``RUN`` is a run of ``w2m demo --kind living``. The film has 8 s at 960x540: photos, cells coloured
by class, blocks, a walk from day into evening, and the way of an agent through the room.
"""

import argparse
import io
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockVolume
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.navigation.moves import get_move_set
from world2minecraft.navigation.oracle import plan_expert_path
from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence
from world2minecraft.navigation.scene import open_scene
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.presentation.film import PAPER, SUPERSAMPLE, RoomStage, joined
from world2minecraft.rendering.presentation.opened_room import OpenedBuild
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.walk_through import plan_tour

SIZE, RATE_HZ, QUALITY = (960, 540), 10, 62
PHOTOS_S, CELLS_S, BLOCKS_S, WALK_S, WAY_S = 1.3, 1.4, 1.4, 2.4, 1.5
TURN_DEG, WALK_FOV_DEG = 24.0, 62.0
HOURS = (15.0, 18.6)
TRAIL = (240, 96, 32)


def frames_of(seconds: float) -> int:
    """Return the number of frames of a part of the film."""
    return round(seconds * RATE_HZ)


def photo_frames(run: Path) -> Iterator[np.ndarray]:
    """Yield frames in which photos of the capture appear one by one."""
    paths = sorted((run / "capture" / "colour").iterdir())
    chosen = [paths[n] for n in np.linspace(0, len(paths) - 1, 6).astype(int)]
    across, down, gap = 3, 2, 8
    width = (SIZE[0] - gap * (across + 1)) // across
    height = (SIZE[1] - gap * (down + 1)) // down
    pictures = [_cropped(path, width, height) for path in chosen]
    count = frames_of(PHOTOS_S)
    for frame in range(count):
        sheet = Image.new("RGB", SIZE, PAPER)
        shown = min(len(pictures), 1 + frame * len(pictures) // max(count - 3, 1))
        for number, picture in enumerate(pictures[:shown]):
            row, column = divmod(number, across)
            sheet.paste(picture, (gap + column * (width + gap), gap + row * (height + gap)))
        yield np.asarray(sheet)


def _cropped(path: Path, width: int, height: int) -> Image.Image:
    with Image.open(path) as image:
        whole = image.convert("RGB")
    scale = max(width / whole.width, height / whole.height)
    size = (round(whole.width * scale), round(whole.height * scale))
    left, top = (size[0] - width) // 2, (size[1] - height) // 2
    resized = whole.resize(size, Image.Resampling.LANCZOS)
    return resized.crop((left, top, left + width, top + height))


def walk_frames(volume: BlockVolume) -> Iterator[np.ndarray]:
    """Yield frames of a walk through the room while the sun sets."""
    scene, count = prepare_scene(volume), frames_of(WALK_S)
    camera = camera_of(*SIZE, vertical_fov_deg=WALK_FOV_DEG)
    tour = plan_tour(volume, camera, None, rate_hz=RATE_HZ)
    first = len(tour.shots) // 4
    for frame, shot in enumerate(tour.shots[first : first + count]):
        hour = float(np.interp(frame, (0.2 * count, 0.9 * count), HOURS))
        picture = render_volume(
            scene,
            camera,
            shot.camera_to_room,
            outputs=("colour",),
            light=LightSettings(hour=hour),
            samples=SUPERSAMPLE,
        )
        if picture.colour is not None:
            yield picture.colour


def agent_way(build_folder: Path) -> tuple[str, np.ndarray]:
    """Return an instruction and the way of the expert that follows it, [N, 3] in room metres."""
    scene = open_scene(build_folder)
    named = sorted(scene.landmarks, key=lambda one: one.name)
    best: tuple[str, np.ndarray] = ("", np.zeros((0, 3)))
    for landmark in named:
        try:
            wish = GoalRequest(f"Go to the {landmark.name}", goal=landmark.name)
            episode = episode_of_sentence(scene, wish)
        except Exception:  # The next thing may have floor before it.
            continue
        way = plan_expert_path(
            scene, episode.start, episode.goals, get_move_set("vlnce"), facing=episode.facing
        )
        if way is not None and len(way.stances) > len(best[1]):
            feet = np.array([one.feet for one in way.stances])
            best = (wish.instruction, scene.to_room_m(feet))
    return best


def with_way(stage: RoomStage, pose: np.ndarray, way_m: np.ndarray, share: float) -> np.ndarray:
    """Return a frame of the blocks with the first part of a way drawn on the floor."""
    camera = stage.camera
    seen = apply(invert_rigid(pose), way_m + np.array([0, 0, 0.06]))
    pixels = [
        (camera.fx_px * x / z + camera.cx_px, camera.fy_px * y / z + camera.cy_px)
        for x, y, z in seen[: max(2, round(share * len(seen)))]
    ]
    image = Image.fromarray(stage.blocks(pose)[0])
    draw = ImageDraw.Draw(image)
    draw.line(pixels, TRAIL, 5, "curve")
    x, y = pixels[-1]
    draw.ellipse((x - 9, y - 9, x + 9, y + 9), TRAIL, (255, 255, 255), 3)
    return np.asarray(image)


def film(run: Path) -> list[np.ndarray]:
    """Return all frames of the film of a run."""
    volume, (grid, _) = read_built(run / "build"), read_room(run / "room.npz")
    stage = RoomStage(OpenedBuild(volume), grid, SIZE)
    poses = stage.turning_poses(frames_of(CELLS_S + BLOCKS_S + WAY_S), TURN_DEG)
    cells, blocks = frames_of(CELLS_S), frames_of(BLOCKS_S)
    instruction, way_m = agent_way(run)
    last = poses[cells + blocks :]
    parts = [
        ("photos", list(photo_frames(run))),
        ("semantic occupancy", [stage.cells(p, stage.opened_labels(p))[0] for p in poses[:cells]]),
        ("blocks", [stage.blocks(pose)[0] for pose in poses[cells : cells + blocks]]),
        ("walk in it", list(walk_frames(volume))),
        (
            instruction,
            [with_way(stage, pose, way_m, (n + 1) / len(last)) for n, pose in enumerate(last)],
        ),
    ]
    return joined(parts)


def animated(frames: list[np.ndarray]) -> bytes:
    """Return frames as an animated WebP."""
    stream = io.BytesIO()
    first, *others = [Image.fromarray(frame) for frame in frames]
    first.save(
        stream, "WEBP", save_all=True, append_images=others, duration=round(1000 / RATE_HZ),
        loop=0, quality=QUALITY, method=4,
    )  # fmt: skip
    return stream.getvalue()


def main() -> None:
    """Write the film of a run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("out", type=Path)
    chosen = parser.parse_args()
    frames = film(chosen.run)
    data = animated(frames)
    write_bytes(chosen.out, data)
    sys.stdout.write(f"{chosen.out}: {len(frames) / RATE_HZ:.1f} s, {len(data) / 1e6:.1f} MB\n")


if __name__ == "__main__":
    main()
