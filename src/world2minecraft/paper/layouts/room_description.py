"""Describe a room in words: the input of methods that make layouts of text.

From a finished run, a truth or a layout the words are put together by rule, from rooms and boxes;
from photos, spread evenly over a capture, a model writes them. ``for_method`` puts them into the
form that each method reads.
"""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import read_colour
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import CaptureError, ServerError, UnknownNameError
from world2minecraft.core.types import Layout, LayoutObject, Opening, Placement
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import Picture, Turn
from world2minecraft.external_models.structured_replies import strip_reasoning
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.layoutgpt import SHORTER_PX
from world2minecraft.paper.layouts.importers.value_checks import clean_name
from world2minecraft.paper.layouts.judge import QUALITY, prompt_text
from world2minecraft.rendering.output.images import colour_bytes

LONGEST_PX = 1024

METHODS = ("text", "layoutgpt", "idesign", "layoutvlm")
AT_WALL_M = 0.25  # What is nearer to a wall stands at it.
SIDES = ("west", "east", "south", "north")
DESCRIBE = "describe.md"
# The first kind of which a word is in a room's things.
KINDS = (
    ("kitchen", ("stove", "fridge", "refrigerator", "counter", "oven", "dishwasher", "kitchen")),
    ("bathroom", ("toilet", "bathtub", "shower")),
    ("bedroom", ("bed", "crib")),
    ("living room", ("sofa", "couch", "loveseat")),
    ("dining room", ("dining",)),
    ("office", ("desk",)),
)
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def capture_photos(place: Path, count: int) -> list[Picture]:
    """Return at most ``count`` photos of a capture, JPEG, 1,024 pixels long at most.

    Raises:
        CaptureError: it is no capture, or has no pictures in colour.
    """
    paths = [frame.colour_path for frame in find_capture(place).frames if frame.colour_path]
    chosen = min(count, len(paths))
    wanted = [paths[int((n + 0.5) * len(paths) / chosen)] for n in range(chosen)]
    photos = [Picture(colour_bytes(_small(read_colour(path)), ".jpg", QUALITY)) for path in wanted]
    if not photos:
        raise CaptureError(place, "has no pictures in colour; leave out --agent")
    return photos


def _small(colour: np.ndarray) -> np.ndarray:
    picture = Image.fromarray(colour)
    picture.thumbnail((LONGEST_PX, LONGEST_PX), Image.Resampling.LANCZOS)
    return np.asarray(picture)


def describe_scene(scene: ComparedScene) -> str:
    """Return a scene in plain sentences; the north wall is at the greatest y of the room's frame.

    A person reads them, and so does any method that starts from text.
    """
    parts = []
    for number, room in enumerate(scene.rooms):
        own = [item for item in scene.objects if _owner(item, scene.rooms) == number]
        parts.append(_room_words(room, own))
    return "\n\n".join(parts) + "\n"


def describe_photos(model: ChatModel, photos: Sequence[Picture]) -> str:
    """Return what a model says of a room by its photos; the prompt is ``prompts/describe.md``.

    Raises:
        ServerError: the model cannot be asked, or says nothing. BudgetError: a cap is reached.
    """
    _, reply = model.ask((Turn("user", (prompt_text(DESCRIBE), *photos)),))
    text = strip_reasoning(reply.text).strip()
    if not text:
        raise ServerError(f"{model.name} says nothing of the photos; try another model")
    return f"{text}\n"


def for_method(method: str, scene: ComparedScene, words: str) -> Any:
    """Return a description as a method reads it: text, or plain values for JSON.

    Args:
        method: ``text``, ``layoutgpt`` (the condition of its prompt), ``idesign`` (its arguments)
            or ``layoutvlm`` (a scene file, to which assets must be added).
        scene: for the room's size.
        words: as ``describe_scene`` or ``describe_photos`` gives them.

    Raises:
        UnknownNameError: there is no such method.
    """
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    room = scene.rooms[0]
    size = np.ptp(room.floor_polygon_m, axis=0)
    if method == "layoutgpt":
        length, width = (round(float(side) / layoutgpt_px_m(scene)) for side in size)
        return (
            f"Condition:\nRoom Type: {room_kind(scene)}\n"
            f"Room Size: max length {length}px, max width {width}px\n"
        )
    if method == "idesign":
        return {
            "user_input": words.strip(),
            "room_dimensions": [round(float(v), 2) for v in (*size, room.wall_height_m)],
            "no_of_objects": len(scene.objects),
        }
    if method == "layoutvlm":
        corners = [[round(float(x), 3), round(float(y), 3), 0] for x, y in room.floor_polygon_m]
        return {
            "task_description": words.strip(),
            "layout_criteria": "the layout should follow the task description",
            "boundary": {
                "floor_vertices": corners,
                "wall_height": round(float(room.wall_height_m), 3),
            },
            "assets": {},
        }
    return words


def layoutgpt_px_m(scene: ComparedScene) -> float:
    """Return the metres of a pixel of what LayoutGPT lays out for a scene's first room."""
    return float(np.ptp(scene.rooms[0].floor_polygon_m, axis=0).min()) / SHORTER_PX


def room_kind(scene: ComparedScene) -> str:
    """Return the kind of a room by what stands in it."""
    names = " ".join(name_of(item) for item in scene.objects)
    return next((kind for kind, words in KINDS if any(word in names for word in words)), "room")


def name_of(item: LayoutObject | Placement) -> str:
    """Return what a person calls a thing."""
    kind = CLASS_NAMES[item.class_id]
    plain = {"tvs": "television", "furn": "piece of furniture", "objs": "object"}.get(kind, kind)
    if isinstance(item, Placement):
        is_known = item.template in TEMPLATES.names()
        return template(item.template).title.lower() if is_known else plain
    words = "".join(c if c.isalpha() else " " for c in item.name).split()
    return clean_name(" ".join(words).lower()) if words else plain


def _owner(item: Any, rooms: Sequence[Layout]) -> int:
    """Return the room whose middle of the nearest floor a thing is over: by its outline's box."""
    place = np.asarray(item.center_m)

    def away(room: Layout) -> float:
        low, high = room.floor_polygon_m.min(axis=0), room.floor_polygon_m.max(axis=0)
        flat = np.maximum(np.maximum(low - place[:2], place[:2] - high), 0)
        up = max(room.floor_z_m - place[2], place[2] - room.floor_z_m - room.wall_height_m, 0)
        return float(np.hypot(*flat) + up)

    return min(range(len(rooms)), key=lambda number: away(rooms[number]))


def _room_words(room: Layout, objects: Sequence[Any]) -> str:
    size = np.ptp(room.floor_polygon_m, axis=0)
    held = ComparedScene(room.name, "", (room,), tuple(objects))
    kind = room_kind(held)
    article = "An" if kind[0] in "aeiou" else "A"
    lines = [
        f"{article} {kind} of {size[0]:.1f} m from west to east and {size[1]:.1f} m from south to "
        f"north, {room.wall_height_m:.1f} m high."
    ]
    if len(room.floor_polygon_m) > 4:
        lines.append(f"Its floor has {len(room.floor_polygon_m)} corners.")
    lines += [_opening_words(one, room) for one in room.openings]
    groups = Counter((name_of(item), _where(item, room), _size_words(item)) for item in objects)
    lines += [
        f"There {'is' if n == 1 else 'are'} {_count(n, name)} ({size_words}) {where}."
        for (name, where, size_words), n in groups.items()
    ]
    return " ".join(lines)


def _opening_words(opening: Opening, room: Layout) -> str:
    middle = (opening.start_m + opening.end_m) / 2
    wide = float(np.linalg.norm(opening.end_m - opening.start_m))
    return f"There is a {opening.kind} of {wide:.1f} m in the {_nearest(middle, room)[0]} wall."


def _where(item: Any, room: Layout) -> str:
    """Return where a thing stands: at a wall if it is near one, high or low."""
    half = np.asarray(item.size_m[:2]) / 2
    yaw = getattr(item, "yaw_deg", None)
    yaw = 90.0 * item.quarter_turns if yaw is None else yaw
    angle = np.radians(yaw)
    turn = np.abs([[np.cos(angle), np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    side, away = _nearest(np.asarray(item.center_m[:2]), room, turn @ half)
    bottom = float(item.center_m[2] - item.size_m[2] / 2) - room.floor_z_m
    if away <= AT_WALL_M:
        return f"{'high on' if bottom > 1.0 else 'at'} the {side} wall"
    return "hanging in the room" if bottom > 1.0 else f"{away:.1f} m from the {side} wall"


def _nearest(point: np.ndarray, room: Layout, half: Any = (0.0, 0.0)) -> tuple[str, float]:
    """Return the side of the box around a room that is nearest, and how far it is, metres."""
    low, high = room.floor_polygon_m.min(axis=0), room.floor_polygon_m.max(axis=0)
    gaps = [point[0] - half[0] - low[0], high[0] - point[0] - half[0],
            point[1] - half[1] - low[1], high[1] - point[1] - half[1]]  # fmt: skip
    number = int(np.argmin(gaps))
    return SIDES[number], max(float(gaps[number]), 0.0)


def _size_words(item: Any) -> str:
    deep, wide, high = (float(v) for v in item.size_m)
    return f"{wide:.1f} m wide, {deep:.1f} m deep, {high:.1f} m high"


def _count(number: int, name: str) -> str:
    number_word = _COUNTS[number] if number < len(_COUNTS) else str(number)
    return f"{number_word} {name if number == 1 else plural_of(name)}"


def plural_of(name: str) -> str:
    """Return the plural of a thing's name.

    Example:
        >>> [plural_of(one) for one in ("box", "wall shelf", "chest of drawers", "curtains")]
        ['boxes', 'wall shelves', 'chests of drawers', 'curtains']
    """
    noun, of, rest = name.partition(" of ")
    if noun.endswith("s") and not noun.endswith("ss"):
        return name  # It is one already, such as stairs.
    if noun.endswith(("ss", "x", "ch", "sh")):
        noun += "es"
    elif noun.endswith("y") and noun[-2:-1] not in "aeiou":
        noun = noun[:-1] + "ies"
    elif noun.endswith("lf"):
        noun = noun[:-1] + "ves"
    else:
        noun += "s"
    return noun + of + rest
