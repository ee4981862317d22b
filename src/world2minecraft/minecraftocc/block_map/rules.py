"""The types of a block map, which assigns classes by block name and by position.

The name of a block determines its class or its kind. Each kind has an ordered list of rules, and
the first rule that applies to a block determines its class. A map is therefore a plain table that
can be read and edited without changing code.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import translate
from functools import cached_property
from typing import NamedTuple

from world2minecraft.core.classes import CLASS_NAMES

Span = tuple[float, float]
ANY = "*"  # The namespace of words that apply to all mods.


class Pattern(NamedTuple):
    """A pattern for block names with required properties, such as ``*_slab[type=double]``."""

    name: re.Pattern[str]
    properties: tuple[str, ...]  # "type=double"
    text: str


@dataclass(frozen=True)
class Rule:
    """A class, with the conditions under which a block belongs to it."""

    class_name: str
    where: tuple[str, ...] = ()  # names of conditions; "not NAME" inverts one
    spans: Mapping[str, Span] = field(default_factory=dict)  # measures of the piece
    shares: Mapping[str, Span] = field(default_factory=dict)  # kinds of the piece's blocks

    @property
    def always(self) -> bool:
        """Whether the rule has no conditions and applies to every block."""
        return not (self.where or self.spans or self.shares)


@dataclass(frozen=True)
class Words:
    """Classes or kinds for words in the block names of mods.

    Attributes:
        namespaces: Prefixes of the namespaces to which the words apply, or ``*`` for all mods.
        meanings: Class or kind for each word.
    """

    namespaces: tuple[str, ...]
    meanings: Mapping[str, str]

    @cached_property
    def _by_length(self) -> list[str]:
        return sorted(self.meanings, key=len, reverse=True)

    def of(self, namespace: str, name: str) -> str | None:
        """Return the class or kind for the longest known word in a block name.

        If several words have this length, the last one in the name is used. Returns None if the
        name contains no known word.
        """
        applies = any(
            namespace != "minecraft" if start == ANY else namespace.startswith(start)
            for start in self.namespaces
        )
        found = [word for word in self._by_length if word in name] if applies else []
        if not found:
            return None
        alike = [word for word in found if len(word) == len(found[0])]
        return self.meanings[max(alike, key=name.rfind)]


@dataclass(frozen=True, eq=False)
class BlockMap:
    """A table that assigns blocks to classes, of the form in docs/reference/block-maps.md."""

    name: str
    about: str
    blocks: Mapping[str, str]  # class or kind of each full id
    words: tuple[Words, ...]
    kinds: Mapping[str, tuple[Pattern, ...]]  # in the order in which they are matched
    whole: str  # class or kind of a full block without an entry
    other: str  # class or kind of any other block without an entry
    structure: frozenset[str]  # kinds of floors, walls and ceilings
    apart: frozenset[str]  # kinds and classes that are never part of an adjacent piece
    sheets: frozenset[str]  # kinds of curtains
    plates: frozenset[str]  # kinds of pictures
    rules: Mapping[str, tuple[Rule, ...]]  # of each kind
    designs: tuple[tuple[Pattern, str], ...]  # classes of furniture designs
    unless_known: frozenset[str]  # kinds that do not replace a stored class
    entities: tuple[tuple[Pattern, str], ...]  # classes of display entities
    _found: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def meaning(self, state: str) -> str:
        """Return the class or kind of a block state, determined from its name alone.

        Example:
            >>> from world2minecraft.minecraftocc.block_map import load_block_map
            >>> load_block_map("nyu").meaning("minecraft:bookshelf")
            'furn'
        """
        if state not in self._found:  # Scenes share most of their states.
            self._found[state] = self._meaning_of(state)
        return self._found[state]

    def _meaning_of(self, state: str) -> str:
        full, _, rest = state.partition("[")
        full = full if ":" in full else f"minecraft:{full}"
        if full in self.blocks:
            return self.blocks[full]
        namespace, _, name = full.partition(":")
        for words in self.words:
            meaning = words.of(namespace, name)
            if meaning is not None:
                return meaning
        stated = frozenset(rest[:-1].split(","))
        for kind, patterns in self.kinds.items():
            if any(matches(pattern, full, name, stated) for pattern in patterns):
                return kind
        return self.whole if _is_whole(state) else self.other

    def rules_of(self, meaning: str) -> tuple[Rule, ...]:
        """Return the rules of a kind, or a single unconditional rule for a class."""
        return (Rule(meaning),) if meaning in CLASS_NAMES else self.rules[meaning]

    def classes_of(self, state: str) -> tuple[str, ...]:
        """Return the possible classes of a block state, in the order of its rules.

        Example:
            >>> from world2minecraft.minecraftocc.block_map import load_block_map
            >>> load_block_map("nyu").classes_of("oak_planks")[:3]
            ('floor', 'ceiling', 'wall')
        """
        rules = self.rules_of(self.meaning(state))
        return tuple(dict.fromkeys(rule.class_name for rule in rules))


def parse_pattern(text: str) -> Pattern:
    """Parse a block name pattern. A pattern without a namespace matches all namespaces."""
    name, _, rest = text.partition("[")
    properties = tuple(part for part in rest.removesuffix("]").split(",") if part)
    return Pattern(re.compile(translate(name)), properties, text)


def matches(pattern: Pattern, full: str, name: str, stated: frozenset[str]) -> bool:
    """Return whether a block matches a pattern.

    Args:
        pattern: Pattern to match.
        full: Block id with its namespace.
        name: Block id without its namespace, used if the pattern has no namespace.
        stated: Properties of the block, such as ``type=double``.
    """
    candidate = full if ":" in pattern.text.partition("[")[0] else name
    return bool(pattern.name.match(candidate)) and stated.issuperset(pattern.properties)


def _is_whole(state: str) -> bool:
    from world2minecraft.minecraft.collision_shapes import is_full_cube  # noqa: PLC0415

    return is_full_cube(state)
