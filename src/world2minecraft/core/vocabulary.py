"""The vocabulary of fine names: toilet, bookcase, office chair and about 110 others.

``data/vocabulary.yaml`` gives each name its class, its NYU40 id, the labels that segmentation
networks and data sets use for it, and the furniture templates that can stand for it. Labels are
found by their names, never by numbers: models that were trained on one data set number its labels
differently.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import (
    CLASS_DISPLAY_NAMES,
    CLASS_NAMES,
    UNKNOWN,
    class_id,
    display_name,
)
from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import load_plain_yaml, read_bytes, read_json

VOCABULARY_FILE = Path(__file__).parent / "data" / "vocabulary.yaml"
NYU40_FILE = Path(__file__).parent / "data" / "nyu40.json"
NOTHING = "nothing"  # Instead of a name: outdoor things, which vote for none.
MAX_BYTES = 1 << 20
NYU40_COUNT = 40
OTHER_NYU40 = 40  # Other prop.
MIN_NAME_CONFIDENCE = 0.5  # Below it, an object has the display name of its class.
# NYU40 classes that annotators use for the same things: cabinet, counter, dresser, night stand;
# table, desk; bookshelf, shelves; floor, floor mat; blinds, curtain, shower curtain.
ALIKE_NYU40 = ((3, 12, 17, 32), (7, 14), (10, 15), (2, 20), (13, 16, 28))
_ENDINGS = re.compile(r" (merged|stuff|other)$")
_KEYS = {"class", "nyu40", "also", "templates", "title"}


@dataclass(frozen=True)
class ThingName:
    """A name of the vocabulary.

    Attributes:
        name: The name, such as ``office chair``.
        class_id: Its class, 1 to 11.
        nyu40: The nearest NYU40 class, 1 to 40.
        labels: Labels that mean it, in lower case.
        templates: Furniture templates that can stand for it, the usual one first.
        title: Text that people read.
    """

    name: str
    class_id: int
    nyu40: int
    labels: tuple[str, ...] = ()
    templates: tuple[str, ...] = ()
    title: str = ""


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """The names, and the meaning of labels.

    Attributes:
        names: All names by themselves.
        classes: Class of each label that votes only for a class.
        silent: Labels that vote for nothing.
    """

    names: Mapping[str, ThingName]
    classes: Mapping[str, int]
    silent: frozenset[str]

    def __post_init__(self):
        by_label: dict[str, ThingName] = {}
        by_template: dict[str, ThingName] = {}
        for entry in self.names.values():
            by_label |= dict.fromkeys((entry.name, *entry.labels), entry)
            by_template |= dict.fromkeys(entry.templates, entry)
        for label in (*self.classes, *self.silent):
            by_label.pop(label, None)
        object.__setattr__(self, "_by_label", by_label)
        object.__setattr__(self, "_by_template", by_template)

    def find(self, label: str) -> ThingName | None:
        """Return the name that a label means, or None.

        Of a label with synonyms, such as ``windowpane, window``, the first known word counts.

        Example:
            >>> read_vocabulary().find("Refrigerator, icebox").name
            'refrigerator'
        """
        known: dict[str, ThingName] = self._by_label  # type: ignore[attr-defined]
        return next((known[key] for key in label_keys(label) if key in known), None)

    def of_template(self, template: str) -> ThingName | None:
        """Return the name of what a furniture template shows, or None.

        If it can stand for several names, that is the last of them.

        Example:
            >>> read_vocabulary().of_template("fridge_double").name
            'refrigerator'
        """
        return self._by_template.get(template)  # type: ignore[attr-defined]

    def of_nyu40(self, number: int) -> tuple[ThingName, ...]:
        """Return the names of an NYU40 class, 1 to 40."""
        return tuple(entry for entry in self.names.values() if entry.nyu40 == number)

    def label_table(self) -> dict[str, int | None]:
        """Return the class of each label, or None for labels that vote for nothing."""
        by_label: dict[str, ThingName] = self._by_label  # type: ignore[attr-defined]
        table: dict[str, int | None] = {key: one.class_id for key, one in by_label.items()}
        return table | dict(self.classes) | dict.fromkeys(self.silent)


def object_title(name: str, class_id: int) -> str:
    """Return the text that people read for an object: the title of its name, or its class.

    Example:
        >>> object_title("toilet", 11), object_title("", 9), object_title("toy robot", 11)
        ('toilet', 'television', 'toy robot')
    """
    if not name or name == display_name(class_id):
        return display_name(class_id)
    entry = read_vocabulary().names.get(name)
    return entry.title if entry else name


def nyu40_of(name: str, class_id: int) -> int:
    """Return the NYU40 id of an object's name, or of its class if the name is unknown.

    Example:
        >>> nyu40_of("toilet", 11), nyu40_of("", 5)
        (33, 5)
    """
    names = read_vocabulary().names
    return (names.get(name) or names[display_name(class_id)]).nyu40


def label_keys(label: str) -> list[str]:
    """Return the keys under which a label is looked up: the whole label, then its synonyms.

    Example:
        >>> label_keys("Floor-Other-Merged"), label_keys("tv, monitor")
        (['floor', 'floor'], ['tv, monitor', 'tv', 'monitor'])
    """
    return [_plain(label), *map(_plain, re.split(r"[,;]", label))]


def _plain(label: str) -> str:
    plain = " ".join(re.sub(r"[-_/\s]+", " ", label.lower()).split())
    while plain != (shorter := _ENDINGS.sub("", plain)):
        plain = shorter
    return plain


def read_vocabulary(own: str | Path = "") -> Vocabulary:
    """Return the vocabulary, changed and extended by a file of the user.

    Args:
        own: Path of a YAML file in the form of ``data/vocabulary.yaml``.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid vocabulary.
    """
    return _read(Path(own), _shipped()) if own else _shipped()


@cache
def _shipped() -> Vocabulary:
    return _read(VOCABULARY_FILE, Vocabulary({}, {}, frozenset()))


def _read(path: Path, base: Vocabulary) -> Vocabulary:
    try:
        raw = load_plain_yaml(read_bytes(path, MAX_BYTES))
    except ValueError as error:
        raise DamagedFileError(path, f"is not valid YAML ({error})") from None
    rows = raw if isinstance(raw, dict) else {}
    if not rows:
        raise DamagedFileError(
            path, "must map names or classes to labels, such as chair: [stool, armchair]"
        )
    names, classes, silent = dict(base.names), dict(base.classes), set(base.silent)
    for key, value in rows.items():
        if isinstance(value, dict):
            entry = _entry(path, str(key), value)
            _claim((*entry.labels, entry.name), names, classes, silent)
            names[entry.name] = entry
            continue
        if not isinstance(value, list):
            raise DamagedFileError(path, f"the entry {key!r} must be a list of label names")
        labels = tuple(_plain(str(label)) for label in value)
        if key in names:
            _claim(labels, names, classes, silent)
            names[key] = replace(names[key], labels=(*names[key].labels, *labels))
        elif key == NOTHING:
            silent |= set(labels)
        else:
            _claim(labels, names, classes, silent)
            classes |= dict.fromkeys(labels, _class_of(path, str(key)))
    return Vocabulary(names, classes, frozenset(silent))


def _claim(
    labels: Iterable[str], names: dict[str, ThingName], classes: dict[str, int], silent: set[str]
) -> None:
    """Take labels away from what they meant before."""
    wanted = set(labels)
    silent -= wanted
    for label in wanted & set(classes):
        del classes[label]
    for name, entry in names.items():
        if wanted & set(entry.labels):
            names[name] = replace(entry, labels=tuple(x for x in entry.labels if x not in wanted))


def _entry(path: Path, key: str, value: Mapping[str, Any]) -> ThingName:
    if unknown := set(value) - _KEYS:
        error = UnknownNameError("setting", str(min(unknown, key=str)), sorted(_KEYS))
        raise DamagedFileError(path, f"in the entry {key!r}, {error}")
    nyu40 = str(value.get("nyu40") or "")
    if nyu40 and nyu40 not in nyu40_names():
        error = UnknownNameError("NYU40 class", nyu40, nyu40_names())
        raise DamagedFileError(path, f"in the entry {key!r}, {error}")
    for name in ("also", "templates"):
        if not isinstance(value.get(name, []), list):
            raise DamagedFileError(path, f"in the entry {key!r}, {name} must be a list")
    name = _plain(key)
    return ThingName(
        name=name,
        class_id=_class_of(path, str(value.get("class", "objs"))),
        nyu40=nyu40_names()[nyu40] if nyu40 else OTHER_NYU40,
        labels=tuple(_plain(str(label)) for label in value.get("also", [])),
        templates=tuple(str(template) for template in value.get("templates", [])),
        title=str(value.get("title", name)),
    )


def _class_of(path: Path, name: str) -> int:
    if name not in (*CLASS_NAMES[1:], *CLASS_DISPLAY_NAMES[1:]):
        error = UnknownNameError("class", name, (*CLASS_DISPLAY_NAMES[1:], NOTHING))
        raise DamagedFileError(path, str(error))
    return class_id(name)


@cache
def nyu40_classes() -> np.ndarray:
    """Return the class id for each NYU40 label as uint8 [65536], 255 if unknown."""
    classes = np.full(65536, UNKNOWN, np.uint8)
    for number, (_, name) in read_json(NYU40_FILE)["classes"].items():
        classes[int(number)] = class_id(name)
    return classes


@cache
def alike_nyu40(number: int) -> frozenset[int]:
    """Return the NYU40 classes whose things pass for those of an NYU40 class.

    Classes that the segmentation network never sees, such as other prop, pass for all classes
    with the same one of the program's twelve classes.

    Example:
        >>> sorted(alike_nyu40(7)), sorted(alike_nyu40(5))
        ([7, 14], [5])
    """
    if number in (38, 39, OTHER_NYU40):
        return frozenset(np.flatnonzero(nyu40_classes() == nyu40_classes()[number]).tolist())
    return next((frozenset(group) for group in ALIKE_NYU40 if number in group), frozenset({number}))


@cache
def nyu40_names() -> dict[str, int]:
    """Return the NYU40 id, 1 to 40, for each class name such as ``"night stand"``."""
    listed = read_json(NYU40_FILE)["classes"].items()
    return {name: int(number) for number, (name, _) in listed}


# Label ids: 1 to 40 are the NYU40 classes, the numbers after them the names of the vocabulary.
FIRST_NAME_ID = NYU40_COUNT + 1
_CLASS_NYU40 = {"furn": "other furniture", "objs": "other prop", "tvs": "television"}


@cache
def label_id_names() -> tuple[str, ...]:
    """Return the text of each label id: none for 0, NYU40 classes 1 to 40, then all names."""
    return ("", *sorted(nyu40_names(), key=nyu40_names().__getitem__), *read_vocabulary().names)


@cache
def label_id_classes() -> np.ndarray:
    """Return the class of each label id as uint8 [N], 255 for 0."""
    names = [entry.class_id for entry in read_vocabulary().names.values()]
    classes = np.concatenate([nyu40_classes()[:FIRST_NAME_ID], np.array(names, np.uint8)])
    classes[0] = UNKNOWN
    return classes


@cache
def label_id_nyu40() -> np.ndarray:
    """Return the NYU40 class of each label id from 1, 1 to 40, as int64 [N]."""
    names = [entry.nyu40 for entry in read_vocabulary().names.values()]
    return np.array([*range(1, FIRST_NAME_ID), *names])


def label_id_of(label: str, vocabulary: Vocabulary | None = None) -> int | None:
    """Return the label id of a text, 0 if it votes for nothing, or None if it is unknown.

    Names that only ``vocabulary`` has, which defaults to the shipped one, have no id.

    Example:
        >>> label_id_names()[label_id_of("toilet")], label_id_of("sky"), label_id_of("gizmo")
        ('toilet', 0, None)
    """
    vocabulary = vocabulary or read_vocabulary()
    if (entry := vocabulary.find(label)) is not None and entry.name in read_vocabulary().names:
        return label_id_names().index(entry.name, FIRST_NAME_ID)
    for key in label_keys(label):
        if key in vocabulary.silent:
            return 0
        if key in nyu40_names():
            return nyu40_names()[key]
        if key in vocabulary.classes:
            name = CLASS_NAMES[vocabulary.classes[key]]
            return nyu40_names()[_CLASS_NYU40.get(name, name)]
    return None
