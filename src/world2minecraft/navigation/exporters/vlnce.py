"""Export to VLN-CE: ``SPLIT/SPLIT.json.gz`` and ``SPLIT/SPLIT_gt.json.gz`` in the format VLN-CE-v1.

VLN-CE's loader creates an object from the keys of each episode, so additional keys are only allowed
in ``info``. ``instruction_tokens`` are indices into one vocabulary for all splits, padded with 0 or
truncated to 200 tokens as in R2R.

Positions are in Habitat's metres, with x east, y up and z south. They match the stages written by
``w2m convert SCENE NAME.habitat``, which are placed by ``block_to_room`` from the scene's
``scene.json``. Scenes without this file are placed at their world's origin and scaled by the block
size.
"""

import gzip
import json
import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import ROOM_AXES_TO_BLOCK, apply
from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json, write_bytes, write_json
from world2minecraft.core.types import checks
from world2minecraft.navigation.exporters.options import ExportedFile
from world2minecraft.navigation.records import resolve_scene_path
from world2minecraft.navigation.types import SPLITS, Episode, Move, Stance

SCENE_FILE = "scene.json"
PAD, UNKNOWN = "<pad>", "<unk>"
TOKENS = 200  # As in VLN-CE's own episodes.
GOAL_RADIUS_M = 3.0  # VLN-CE's success distance.
SPARSE_M = 2.0  # Distance between the points of a reference path, about that of R2R.


def block_to_habitat(scene: str, set_folder: Path, metres_per_block: float) -> np.ndarray:
    """Return the 4x4 transform from world blocks to a scene's stage in Habitat.

    Args:
        scene: The scene path of an episode, as accepted by ``resolve_scene_path``.
        set_folder: The folder of the set.
        metres_per_block: The scale of a scene without a ``scene.json``.

    Raises:
        DamagedFileError: If ``scene.json`` contains no valid transform.
    """
    place = resolve_scene_path(scene, set_folder)
    for folder in (place, place / "build", place.parent):
        if (folder / SCENE_FILE).is_file():
            room_to_habitat = np.eye(4)
            room_to_habitat[:3, :3] = ROOM_AXES_TO_BLOCK
            return room_to_habitat @ _block_to_room(folder / SCENE_FILE)
    return np.diag([metres_per_block] * 3 + [1.0])


def positions(to_habitat: np.ndarray, feet: Iterable[tuple[float, float, float]]) -> list:
    """Convert block positions to Habitat's metres, rounded to 0.1 mm, as nested lists."""
    points = np.array(list(feet), np.float64).reshape(-1, 3)
    return (np.round(apply(to_habitat, points), 4) + 0.0).tolist()


def rotation(stance: Stance) -> list[float]:
    """Convert a heading to Habitat's quaternion x, y, z, w, whose identity looks along -z.

    Example:
        >>> rotation(Stance(0, 0, 0, yaw_deg=180.0))  # North.
        [0.0, 0.0, 0.0, 1.0]
    """
    half = math.radians(180.0 - stance.yaw_deg) / 2
    return [0.0, round(math.sin(half), 6) + 0.0, 0.0, round(math.cos(half), 6) + 0.0]


def _block_to_room(path: Path) -> np.ndarray:
    try:
        return checks.similarity("block_to_room", read_json(path)["block_to_room"])
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain a valid transform ({error})") from error


def write_vlnce(
    root: Path, episodes: Sequence[Episode], set_folder: Path, metres_per_block: dict[str, float]
) -> list[ExportedFile]:
    """Write episodes for VLN-CE, and return the written files.

    Args:
        root: The output folder.
        episodes: The episodes of all splits.
        set_folder: The folder of the set, to which scene paths may be relative.
        metres_per_block: The scale by scene ID, for scenes without a ``scene.json``.

    Raises:
        DamagedFileError: If a scene's ``scene.json`` contains no valid transform.
        OutputError: If the folder cannot be written.
    """
    words = vocabulary(episode.instruction.text for episode in episodes)
    numbers = {word: number for number, word in enumerate(words)}
    frames = {
        episode.scene_id: block_to_habitat(
            episode.scene, set_folder, metres_per_block.get(episode.scene_id, 1.0)
        )
        for episode in episodes
    }
    written, ids = [], {episode.episode_id: n for n, episode in enumerate(episodes, 1)}
    ways = {name: n for n, name in enumerate(sorted({_way(one) for one in episodes}), 1)}
    for split in SPLITS:
        chosen = [episode for episode in episodes if episode.split == split]
        if not chosen:
            continue
        entries, truths = [], {}
        for episode in chosen:
            frame, number = frames[episode.scene_id], ids[episode.episode_id]
            entry = _entry(episode, number, ways[_way(episode)], frame, numbers)
            entries.append(entry)
            truths[str(number)] = _truth(episode, frame)
        whole = {"episodes": entries, "instruction_vocab": {"word_list": words}}
        write_bytes(root / split / f"{split}.json.gz", _gzip(whole))
        write_bytes(root / split / f"{split}_gt.json.gz", _gzip(truths))
        written.append(ExportedFile(split, len(chosen)))
    write_json(root / "names.json", {"episodes": ids, "trajectories": ways})
    return written


def vocabulary(texts: Any) -> list[str]:
    """Return the sorted vocabulary of texts, preceded by the padding and unknown tokens."""
    return [PAD, UNKNOWN, *sorted({word for text in texts for word in split_words(text)})]


def split_words(text: str) -> list[str]:
    """Split a sentence into lower-case words and punctuation marks, like Habitat's tokenizer."""
    return re.findall(r"[^\W_]+|[^\w\s]", text.lower())


def _way(episode: Episode) -> str:
    return episode.trajectory_id or episode.episode_id


def _entry(
    episode: Episode, number: int, way: int, frame: np.ndarray, numbers: dict[str, int]
) -> dict[str, Any]:
    text = episode.instruction.text
    tokens = [numbers[word] for word in split_words(text)][:TOKENS]
    way_points = [stance.feet for stance in episode.reference] or [episode.start.feet]
    way_m = positions(frame, way_points)
    return {
        "episode_id": number,
        "trajectory_id": way,
        "scene_id": f"{episode.scene_id}/stages/{episode.scene_id}.glb",
        "start_position": positions(frame, [episode.start.feet])[0],
        "start_rotation": rotation(episode.start),
        "info": {"geodesic_distance": _length_m(way_m), "name": episode.episode_id},
        "goals": [
            {"position": place, "radius": GOAL_RADIUS_M}
            for place in positions(frame, episode.goals)
        ],
        "instruction": {
            "instruction_text": text,
            "instruction_tokens": tokens + [0] * (TOKENS - len(tokens)),
        },
        "reference_path": subsample_path(way_m),
    }


def _truth(episode: Episode, frame: np.ndarray) -> dict[str, Any]:
    places = [stance.feet for stance in episode.reference] or [episode.start.feet]
    return {
        "locations": positions(frame, places),
        "actions": [int(move) for move in episode.moves],
        "forward_steps": sum(move == Move.FORWARD for move in episode.moves),
    }


def subsample_path(way_m: list[list[float]]) -> list[list[float]]:
    """Return points of a path about ``SPARSE_M`` metres apart, including its ends."""
    retained = [way_m[0]]
    for place in way_m[1:-1]:
        if np.linalg.norm(np.subtract(place, retained[-1])) >= SPARSE_M:
            retained.append(place)
    return retained if way_m[-1] == retained[-1] else [*retained, way_m[-1]]


def _length_m(way_m: list[list[float]]) -> float:
    steps = np.diff(np.array(way_m), axis=0)
    return round(float(np.linalg.norm(steps, axis=1).sum()), 4)


def _gzip(value: Any) -> bytes:
    """Compress JSON data so that equal values give identical bytes."""
    return gzip.compress(json.dumps(value, allow_nan=False).encode(), mtime=0)
