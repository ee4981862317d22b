"""What one scores without understanding: the least that any model must beat.

A set that can be answered without looking is no test of looking: where a baseline that sees no
picture is right more than ten points above chance, the set is flagged.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UnknownNameError
from world2minecraft.navigation.data.tasks import GRADES
from world2minecraft.navigation.scores import Rate, rate
from world2minecraft.navigation.types import TASKS, Item

FLAG_POINTS = 0.10
SMALL_PX = (32, 18)  # Pictures are compared so small.
MAX_PIXELS = 64_000_000
BLIND_BASELINES = ("majority", "blind")  # These see no picture.
BASELINES = ("uniform", "majority", "blind", "repeat", "nearest", "alike", "odd", "oracle")


@dataclass(frozen=True)
class BaselineRow:
    """A baseline's accuracy on a task; ``chance`` is that of guessing.

    is_held: whether its items are kept from training; those of train where none is.
    """

    name: str
    task: str
    accuracy: Rate
    chance: float
    is_held: bool = True

    @property
    def is_flagged(self) -> bool:
        """Whether it needs no picture and is right too often to be luck."""
        over = self.accuracy.share > self.chance + FLAG_POINTS
        return self.name in BLIND_BASELINES and over and self.accuracy.low > self.chance


Answers = list[str]


def score_baselines(items: Sequence[Item], folder: str | Path) -> list[BaselineRow]:
    """Return the rows of all baselines, on what is held out; on all items where nothing is.

    uniform draws a letter; majority takes the commonest letter, or action, of train; blind has
    learned from the words of train which action they go with; repeat does the last action again;
    nearest takes the picture most like the present one; odd and alike know the choices alone, and
    take the picture least or most like the others; oracle is told. What nearest scores is told by
    grade too, such as "nearest hard".

    Args:
        items: of a set.
        folder: of the set, for its pictures.

    Raises:
        InputError: a picture cannot be read.
    """
    rows = []
    for task in TASKS:
        train = [item for item in items if item.task == task and item.split == "train"]
        held_out = [item for item in items if item.task == task and item.split != "train"]
        held_out = held_out or train
        if not held_out:
            continue
        chance = float(np.mean([1 / len(item.options) for item in held_out]))
        found = _answers(task, train, held_out, Path(folder))
        rows += [_row(name, task, held_out, answers, chance) for name, answers in found.items()]
        for grade in GRADES if "nearest" in found else ():
            own = [n for n, item in enumerate(held_out) if item.extra.get("grade") == grade]
            answers = [found["nearest"][n] for n in own]
            if own:
                rows.append(
                    _row(f"nearest {grade}", task, [held_out[n] for n in own], answers, chance)
                )
    return rows


def _row(
    name: str, task: str, held_out: Sequence[Item], answers: Sequence[str], chance: float
) -> BaselineRow:
    hits = sum(a == item.answer for a, item in zip(answers, held_out, strict=True))
    is_held = all(item.split != "train" for item in held_out)
    return BaselineRow(name, task, rate(hits, len(held_out)), chance, is_held)


def baseline_letters(
    name: str, items: Sequence[Item], questions: Sequence[Item], folder: str | Path
) -> dict[str, str]:
    """Return the letter that a baseline gives to each item asked, by the item's id.

    Args:
        name: one of ``BASELINES``; some know one task alone, and the other's items are left out.
        items: of the set; those of train are what it may learn from.
        questions: the items to answer.
        folder: of the set, for its pictures.

    Raises:
        UnknownNameError: no baseline has this name. InputError: a picture cannot be read.
    """
    if name not in BASELINES:
        raise UnknownNameError("baseline", name, BASELINES)
    letters: dict[str, str] = {}
    for task in TASKS:
        train = [item for item in items if item.task == task and item.split == "train"]
        held_out = [item for item in questions if item.task == task]
        found = _answers(task, train, held_out, Path(folder)) if held_out else {}
        own = found.get(name, [])
        letters |= {item.item_id: letter for item, letter in zip(held_out, own, strict=False)}
    return letters


def _answers(
    task: str, train: Sequence[Item], held_out: Sequence[Item], folder: Path
) -> dict[str, Answers]:
    rng = np.random.default_rng(0)
    uniform = [item.options[rng.integers(len(item.options))].label for item in held_out]
    found = {"uniform": uniform, "majority": _majority(train, held_out)}
    if task == "next_action":
        found["blind"] = _blind(train, held_out)
        found["repeat"] = [_of_text(item, str(item.extra.get("previous", ""))) for item in held_out]
    else:
        found["blind"] = found["majority"]  # Choices without words leave nothing but the letter.
        small = _Thumbnails(folder)
        found["nearest"] = [_chosen(item, lambda i: _to_current(i, small)) for item in held_out]
        found["alike"] = [_chosen(item, lambda i: _to_others(i, small)) for item in held_out]
        found["odd"] = [_chosen(item, lambda i: -_to_others(i, small)) for item in held_out]
    return {**found, "oracle": [item.answer for item in held_out]}


def _majority(train: Sequence[Item], held_out: Sequence[Item]) -> Answers:
    """Return the commonest right letter of train, or its commonest right action."""
    texts = Counter(_text(item, item.answer) for item in train)
    letters = Counter(item.answer for item in train)
    if texts and set(texts) != {""}:
        most = max(sorted(texts), key=lambda text: texts[text])
        return [_of_text(item, most) for item in held_out]
    letter = max(sorted(letters), key=lambda one: letters[one]) if letters else "A"
    return [letter if letter in [o.label for o in item.options] else "A" for item in held_out]


def _blind(train: Sequence[Item], held_out: Sequence[Item]) -> Answers:
    """Return what a naive Bayes classifier takes the words of an instruction to ask for."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    total: Counter[str] = Counter()
    for item in train:
        action = _text(item, item.answer)
        counts[action].update(_words(item))
        total[action] += 1
    vocabulary = len({word for own in counts.values() for word in own}) or 1
    answers = []
    for item in held_out:
        scores = {}
        for option in item.options:
            own = counts[option.text]
            share = np.log((total[option.text] + 1) / (len(train) + len(item.options)))
            size = sum(own.values()) + vocabulary
            scores[option.label] = share + sum(np.log((own[w] + 1) / size) for w in _words(item))
        answers.append(max(sorted(scores), key=lambda label: scores[label]))
    return answers


def _words(item: Item) -> set[str]:
    words = item.instruction.text.lower().replace(",", " ").replace(".", " ").split()
    pairs = {f"{a} {b}" for a, b in pairwise(words)}
    return {*words, *pairs}


def _text(item: Item, label: str) -> str:
    return next(option.text for option in item.options if option.label == label)


def _of_text(item: Item, text: str) -> str:
    """Return the letter of an action; the first where it is not offered."""
    return next((one.label for one in item.options if one.text == text), item.options[0].label)


def _chosen(item: Item, cost: Callable[[Item], np.ndarray]) -> str:
    return item.options[int(cost(item).argmin())].label


def _to_current(item: Item, small: "_Thumbnails") -> np.ndarray:
    now = small[item.current]
    return np.array([float(((small[one.image] - now) ** 2).mean()) for one in item.options])


def _to_others(item: Item, small: "_Thumbnails") -> np.ndarray:
    images = np.stack([small[one.image] for one in item.options])
    return ((images[:, None] - images[None]) ** 2).mean(axis=(1, 2, 3)) * len(images)


class _Thumbnails:
    """Small grey pictures of a set, read when they are asked for."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._known: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._known:
            self._known[name] = _small(self._folder / name)
        return self._known[name]


def _small(path: Path) -> np.ndarray:
    try:
        with Image.open(path) as image:
            if image.width * image.height > MAX_PIXELS:
                raise LimitError(path, f"has {image.width}x{image.height} pixels; too large")
            grey = image.convert("L").resize(SMALL_PX, Image.Resampling.BOX)
    except FileNotFoundError as error:
        raise InputError(path, "is not there, though an item shows it") from error
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        raise DamagedFileError(path, f"is no picture ({error})") from error
    return np.asarray(grey, np.float32)
