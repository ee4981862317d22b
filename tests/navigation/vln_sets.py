"""Sets of a few items with small pictures, for the tests of what reads sets."""

import hashlib
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.navigation.records import write_episodes, write_items, write_trajectories
from world2minecraft.navigation.types import (
    LETTERS,
    Episode,
    Instruction,
    Item,
    Keyframe,
    Move,
    Option,
    Stance,
    Trajectory,
)

ACTIONS = ("move forward", "turn left", "turn right", "stop")
WORDS = Instruction(
    "Turn left at the door, walk past the table and stop at the piano.",
    landmarks=("door", "table", "piano"),
)


def picture(seed: int, width: int = 64, height: int = 36) -> bytes:
    """A JPEG of broad coloured squares, another for each seed."""
    squares = np.random.default_rng(seed).integers(0, 256, (3, 4, 3), np.uint8)
    image = Image.fromarray(squares).resize((width, height), Image.Resampling.NEAREST)
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=90)
    return buffer.getvalue()


def name_of(scene: str, number: int) -> str:
    return f"images/{scene}/t0/{number:03}.jpg"


def a_trajectory(scene: str = "kitchen", split: str = "train", frames: int = 8) -> Trajectory:
    keyframes = []
    for number in range(frames):
        last = number == frames - 1
        chunk = (Move.STOP,) if last else (Move.FORWARD, Move.STOP)
        keyframes.append(
            Keyframe(
                name_of(scene, number),
                Stance(2.0 + number, 64.0, 3.0, -90.0),
                "stop" if last else "move forward",
                chunk,
                sha_of(scene, number),
            )
        )
    return Trajectory(f"{scene}-t0", scene, tuple(keyframes), (WORDS,), 7.0, split, 0.25)


def sha_of(scene: str, number: int, **size: int) -> str:
    return hashlib.sha256(picture(seed_of(scene, number), **size)).hexdigest()


def seed_of(scene: str, number: int) -> int:
    return int.from_bytes(scene.encode()[:4], "big") + number


def next_view(
    scene: str = "kitchen", step: int = 2, split: str = "train", composition: str = "base"
) -> Item:
    """Three past pictures and four choices, the right one lettered by the step."""
    right = LETTERS[step % 4]
    others = iter([0, step + 2, 1])
    numbers = [step + 1 if letter == right else next(others) for letter in LETTERS[:4]]
    options = tuple(
        Option(
            letter,
            "positive" if letter == right else "keyframe",
            image=name_of(scene, number),
            stance=Stance(2.0 + number, 64.0, 3.0, -90.0),
        )
        for letter, number in zip(LETTERS, numbers, strict=False)
    )
    shown = {*range(step - 2, step + 1), *numbers}
    return Item(
        f"{scene}-t0-nv-{step}",
        "next_view",
        scene,
        f"{scene}-t0",
        step,
        WORDS,
        tuple(name_of(scene, number) for number in (step - 2, step - 1)),
        name_of(scene, step),
        options,
        right,
        split,
        composition,
        0.25,
        "follower-1",
        {name_of(scene, number): sha_of(scene, number) for number in sorted(shown)},
        {},
    )


def next_action(
    scene: str = "kitchen", step: int = 0, split: str = "train", composition: str = "base"
) -> Item:
    """A picture and the four actions; the walk is forward, then a stop."""
    right = 3 if step == 7 else 0
    options = tuple(
        Option(letter, "positive" if number == right else "action", text=text)
        for number, (letter, text) in enumerate(zip(LETTERS, ACTIONS, strict=False))
    )
    chunk = [0] if step == 7 else [1, 0]
    return Item(
        f"{scene}-t0-na-{step}",
        "next_action",
        scene,
        f"{scene}-t0",
        step,
        WORDS,
        (),
        name_of(scene, step),
        options,
        LETTERS[right],
        split,
        composition,
        0.25,
        "follower-1",
        {name_of(scene, step): sha_of(scene, step)},
        {"gold_chunk": chunk, "progress": step / 7},
    )


def write_pictures(folder: Path, scene: str, frames: int = 9, **size: int) -> None:
    for number in range(frames):
        path = folder / name_of(scene, number)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(picture(seed_of(scene, number), **size))


SCENES = (
    ("kitchen", "train", "base"),
    ("villa", "train", "extend"),
    ("attic", "val_unseen", "base"),
)


def small_set(folder: Path, **size: int) -> Path:
    """A set of three scenes: 39 items, a trajectory and an episode each."""
    items, trajectories, episodes = [], [], []
    for scene, split, composition in SCENES:
        write_pictures(folder, scene, **size)
        views = [next_view(scene, step, split, composition) for step in range(2, 7)]
        actions = [next_action(scene, step, split, composition) for step in range(8)]
        items += [with_sums(item, **size) for item in (*views, *actions)]
        trajectories.append(a_trajectory(scene, split))
        episodes.append(an_episode(scene, split))
    write_items(folder / "items.jsonl", items)
    write_trajectories(folder / "trajectories.jsonl", trajectories)
    write_episodes(folder / "episodes.jsonl", episodes)
    return folder


def with_sums(item: Item, **size: int) -> Item:
    """An item with the sums of pictures of another size."""
    sums = {name: sha_of(item.scene_id, int(name[-7:-4]), **size) for name in item.sha256}
    return replace(item, sha256=sums)


def an_episode(scene: str, split: str = "train") -> Episode:
    """Seven steps east, as the trajectory goes, told by the same words."""
    way = tuple(Stance(2.0 + number, 64.0, 3.0, -90.0) for number in range(8))
    return Episode(
        f"{scene}-e0",
        f"worlds/{scene}",
        scene,
        way[0],
        ((9.0, 64.0, 3.0),),
        "piano",
        WORDS,
        moves=(Move.FORWARD,) * 7 + (Move.STOP,),
        reference=way,
        trajectory_id=f"{scene}-t0",
        split=split,
        oracle_version="follower-1",
    )
