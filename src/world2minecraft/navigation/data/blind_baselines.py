"""Baseline scores that any model should exceed, and a check for questions solvable without images.

A set is flagged if a baseline that sees no images is more than ten percentage points above chance.
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
SMALL_PX = (32, 18)  # Size at which images are compared.
MAX_PIXELS = 64_000_000
BLIND_BASELINES = ("majority", "blind")  # These do not use images.
BASELINES = ("uniform", "majority", "blind", "repeat", "nearest", "alike", "odd", "oracle")


@dataclass(frozen=True)
class BaselineRow:
    """The accuracy of a baseline on a task.

    Attributes:
        name: The name of the baseline.
        task: The name of the task.
        accuracy: The share of correct answers, with its confidence interval.
        chance: The accuracy of random guessing.
        is_held: Whether the scored items are held out. If False, they are training items.
    """

    name: str
    task: str
    accuracy: Rate
    chance: float
    is_held: bool = True

    @property
    def is_flagged(self) -> bool:
        """Whether a baseline without images scores significantly above chance."""
        over = self.accuracy.share > self.chance + FLAG_POINTS
        return self.name in BLIND_BASELINES and over and self.accuracy.low > self.chance


Answers = list[str]


def score_baselines(items: Sequence[Item], folder: str | Path) -> list[BaselineRow]:
    """Score all baselines on the held-out items, or on all items if none is held out.

    The baselines are:

    - uniform: a random letter.
    - majority: the most frequent correct letter, or action, of the training items.
    - blind: the action that naive Bayes predicts from the instruction's words.
    - repeat: the previous action.
    - nearest: the option whose image is most similar to the current one.
    - odd and alike: the option whose image is least or most similar to the other options.
    - oracle: the correct answer.

    The nearest baseline is also scored for each grade of difficulty, such as "nearest hard".

    Args:
        items: The items of a set.
        folder: The folder of the set, which contains the images.

    Raises:
        InputError: If an image cannot be read.
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
    """Return the letters that a baseline chooses, by item ID.

    Args:
        name: One of ``BASELINES``. Items of tasks that the baseline does not support are omitted.
        items: The items of the set. The training items among them may be used for fitting.
        questions: The items to answer.
        folder: The folder of the set, which contains the images.

    Raises:
        UnknownNameError: If the baseline is unknown.
        InputError: If an image cannot be read.
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
        found["blind"] = found["majority"]  # Without texts, only the letters remain.
        small = _Thumbnails(folder)
        found["nearest"] = [_chosen(item, lambda i: _to_current(i, small)) for item in held_out]
        found["alike"] = [_chosen(item, lambda i: _to_others(i, small)) for item in held_out]
        found["odd"] = [_chosen(item, lambda i: -_to_others(i, small)) for item in held_out]
    return {**found, "oracle": [item.answer for item in held_out]}


def _majority(train: Sequence[Item], held_out: Sequence[Item]) -> Answers:
    """Answer with the most frequent correct action, or letter, of the training items."""
    texts = Counter(_text(item, item.answer) for item in train)
    letters = Counter(item.answer for item in train)
    if texts and set(texts) != {""}:
        most = max(sorted(texts), key=lambda text: texts[text])
        return [_of_text(item, most) for item in held_out]
    letter = max(sorted(letters), key=lambda one: letters[one]) if letters else "A"
    return [letter if letter in [o.label for o in item.options] else "A" for item in held_out]


def _blind(train: Sequence[Item], held_out: Sequence[Item]) -> Answers:
    """Answer with the action that naive Bayes predicts from the instruction's words."""
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
    """Return the letter of an action, or the first letter if the action is not an option."""
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
    """A cache of small grey-scale versions of a set's images."""

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
                raise LimitError(
                    path,
                    f"image of {image.width}x{image.height} pixels exceeds the limit of "
                    f"{MAX_PIXELS:,}",
                )
            grey = image.convert("L").resize(SMALL_PX, Image.Resampling.BOX)
    except FileNotFoundError as error:
        raise InputError(
            path, "image not found, but an item refers to it; build the set again"
        ) from error
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        raise DamagedFileError(path, f"not a readable image ({error})") from error
    return np.asarray(grey, np.float32)
