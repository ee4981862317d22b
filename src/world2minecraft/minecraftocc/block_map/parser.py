"""Parser for block maps in YAML files.

A map can extend a shipped map (``extends``). Its own entries then take precedence over those of the
shipped map.
"""

from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import InputError, UnknownNameError
from world2minecraft.core.files import load_plain_yaml, read_bytes
from world2minecraft.minecraftocc.block_map.block_conditions import CONDITIONS, MEASURES, NEIGHBOURS
from world2minecraft.minecraftocc.block_map.rules import (
    BlockMap,
    Pattern,
    Rule,
    Span,
    Words,
    parse_pattern,
)

MAPS = ("nyu", "paper")
MAX_BYTES = 256 << 10  # The longest that is shipped has 12 kB; PyYAML reads about 100 kB a second.
MAX_NAMES = 8192
MAX_NAME_LENGTH = 120
KEYS = (
    "name", "about", "extends", "blocks", "words", "kinds", "whole", "other", "structure", "apart",
    "sheets", "plates", "rules", "designs", "unless_known", "entities",
)  # fmt: skip
_TABLES = ("blocks", "kinds", "rules", "designs", "entities")
_LISTS = ("structure", "apart", "sheets", "plates", "unless_known")
SPAN_SIZE = 2


def load_block_map(name: str | Path) -> BlockMap:
    """Load a shipped block map by name, or a block map from a file.

    Raises:
        UnknownNameError: If the name is neither a shipped map nor a file.
        InputError: If the file cannot be read or is not a valid block map.
        LimitError: If the file is too large.
    """
    if str(name) in MAPS:
        return load_shipped_map(str(name))
    path = Path(name)
    if path.suffix.lower() not in (".yaml", ".yml", ".json") and not path.exists():
        raise UnknownNameError("block map", str(name), MAPS)
    return read_block_map(path)


def read_block_map(path: Path) -> BlockMap:
    """Read a block map from a YAML file.

    Raises:
        InputError: If the file does not exist or is not a valid block map.
        LimitError: If the file is too large.
    """
    raw = _parse_yaml(read_bytes(path, MAX_BYTES), path)
    try:
        return parse_block_map(raw)
    except ValueError as error:
        raise InputError(path, str(error)) from error


@cache
def load_shipped_map(name: str) -> BlockMap:
    """Return the block map with this name that is shipped with the program."""
    return parse_block_map(_shipped_tree(name))


def parse_block_map(raw: Any) -> BlockMap:
    """Parse a block map from the content of a YAML file.

    Raises:
        ValueError: If the content is not a valid block map.
    """
    keys = _mapping("a block map", raw, KEYS)
    if not isinstance(keys.get("name"), str) or not keys["name"]:
        raise ValueError("the block map has no name; add a line such as name: mine")
    whole = _resolve_extends(keys)
    kinds = {kind: _patterns(f"kind {kind}", v) for kind, v in _table(whole, "kinds").items()}
    known = (*CLASS_NAMES, *kinds)
    table = _table(whole, "rules")
    _check_kinds(kinds, table)
    rules = {kind: _rules(kind, table, kinds) for kind in table}
    return BlockMap(
        name=keys["name"],
        about=str(keys.get("about", "")),
        blocks={
            _full_id(b): _check_name(f"block {b}", m, known)
            for b, m in _table(whole, "blocks").items()
        },
        words=tuple(_words(one, known) for one in _list("words", whole.get("words", []))),
        kinds=kinds,
        whole=_check_name("whole", whole.get("whole", "wall"), known),
        other=_check_name("other", whole.get("other", "objs"), known),
        structure=frozenset(_check_name("structure", k, kinds) for k in _names("structure", whole)),
        apart=frozenset(_check_name("apart", k, known) for k in _names("apart", whole)),
        sheets=frozenset(_check_name("sheets", k, kinds) for k in _names("sheets", whole)),
        plates=frozenset(_check_name("plates", k, kinds) for k in _names("plates", whole)),
        rules=rules,
        designs=_pairs("design", _table(whole, "designs")),
        unless_known=frozenset(
            _check_name("unless_known", k, kinds) for k in _names("unless_known", whole)
        ),
        entities=_pairs("entity", _table(whole, "entities")),
    )


def _resolve_extends(keys: dict[str, Any]) -> dict[str, Any]:
    """Return the keys of a map, completed with those of the map that it extends."""
    if "extends" not in keys:
        return keys
    if keys["extends"] not in MAPS:
        raise ValueError(f"extends must be one of {', '.join(MAPS)}, got {_short(keys['extends'])}")
    below = _resolve_extends(_shipped_tree(keys["extends"]))
    result = below | keys
    for key in _TABLES:
        own, under = keys.get(key, {}), below.get(key, {})
        # The map's own entries come first, so they also take precedence among patterns.
        rest = {name: value for name, value in under.items() if name not in _mapping(key, own)}
        result[key] = {**own, **rest}
    for key in _LISTS:
        result[key] = [*_list(key, keys.get(key, [])), *below.get(key, [])]
    result["words"] = _merge_words(_list("words", keys.get("words", [])), below.get("words", []))
    return result


def _merge_words(own: list[Any], under: list[Any]) -> list[Any]:
    """Merge word tables, with precedence for ``own``, and combine tables of the same namespaces."""
    result = list(own)
    for other in under:
        same = next(
            (n for n, one in enumerate(result) if _namespaces(one) == _namespaces(other)), None
        )
        if same is None:
            result.append(other)
        else:
            words = _mapping("words", _mapping("words", result[same]).get("words", {}))
            result[same] = other | {"words": other["words"] | words}
    return result


def _namespaces(words: Any) -> Any:
    return _mapping("words", words).get("namespaces")


def _shipped_tree(name: str) -> dict[str, Any]:
    place = files("world2minecraft.minecraftocc.block_map").joinpath(f"data/{name}.yaml")
    return _parse_yaml(place.read_bytes(), Path(f"{name}.yaml"))


def _parse_yaml(text: bytes, path: Path) -> Any:
    try:
        return load_plain_yaml(text)
    except ValueError as error:
        raise InputError(path, f"not valid YAML ({' '.join(str(error).split())[:200]})") from error


def _check_kinds(kinds: Iterable[str], rules: Iterable[str]) -> None:
    for kind in kinds:
        if kind not in rules and kind not in CLASS_NAMES:
            raise ValueError(f"kind {kind} has no rules; add an entry for {kind} under rules")
    for kind in rules:
        if kind in CLASS_NAMES:
            raise ValueError(
                f"rules has an entry for {kind}, which is the name of a class; rename the kind"
            )
        if kind not in kinds:
            raise ValueError(
                f"rules has an entry for the unknown kind {kind}; known kinds: {', '.join(kinds)}"
            )


def _rules(kind: str, table: dict[str, Any], kinds: Iterable[str]) -> tuple[Rule, ...]:
    """Return the rules of a kind, with names of other kinds replaced by their rules."""
    rules: list[Rule] = []
    visited, left = {kind}, [*_list(f"rules of {kind}", table[kind])]
    while left:
        one = left.pop(0)
        if isinstance(one, str) and one in table:
            if one in visited:
                raise ValueError(
                    f"the rules of {kind} include the rules of {one} twice; remove one of "
                    "the references"
                )
            visited.add(one)
            left = [*_list(f"rules of {one}", table[one]), *left]
        else:
            rules.append(_rule(kind, one, kinds))
    if not rules or not rules[-1].always:
        raise ValueError(
            f"the last rule of {kind} must be unconditional: give only a class, without where"
        )
    return tuple(rules)


def _rule(kind: str, raw: Any, kinds: Iterable[str]) -> Rule:
    if isinstance(raw, str):
        return Rule(_check_name(f"a rule of {kind}", raw, CLASS_NAMES))
    keys = _mapping(f"a rule of {kind}", raw, ("class", "where", "share", *MEASURES))
    where = _names("where", keys)
    for name in where:
        _check_condition(kind, name.removeprefix("not "), kinds)
    known = (*CLASS_NAMES, *kinds)
    shares = _mapping(f"share of {kind}", keys.get("share", {}))
    return Rule(
        _check_name(f"a rule of {kind}", keys.get("class"), CLASS_NAMES),
        tuple(where),
        {name: _span(f"{name} of {kind}", keys[name]) for name in MEASURES if name in keys},
        {
            _check_name(f"share of {kind}", n, known): _span(f"share of {n}", s)
            for n, s in shares.items()
        },
    )


def _check_condition(kind: str, name: str, kinds: Iterable[str]) -> None:
    side, _, other = name.partition(" ")
    if other and side in NEIGHBOURS:
        _check_name(f"where of {kind}", other, (*CLASS_NAMES, *kinds))
    else:
        _check_name(f"where of {kind}", name, CONDITIONS)


def _words(raw: Any, known: Iterable[str]) -> Words:
    keys = _mapping("words", raw, ("namespaces", "words"))
    spaces = _names("namespaces", {"namespaces": keys.get("namespaces", [])})
    if not spaces:
        raise ValueError("words must have namespaces, such as namespaces: [my_mod]")
    words = _mapping("words", keys.get("words", {}))
    return Words(tuple(spaces), {w: _check_name(f"word {w}", m, known) for w, m in words.items()})


def _pairs(what: str, table: dict[str, Any]) -> tuple[tuple[Pattern, str], ...]:
    pairs = table.items()
    return tuple(
        (parse_pattern(name), _check_name(f"{what} {name}", m, CLASS_NAMES)) for name, m in pairs
    )


def _patterns(what: str, raw: Any) -> tuple[Pattern, ...]:
    return tuple(parse_pattern(text) for text in _names(what, {what: raw}))


def _span(what: str, raw: Any) -> Span:
    is_span = isinstance(raw, list) and len(raw) == SPAN_SIZE
    numbers = [one for one in raw if isinstance(one, int | float)] if is_span else []
    if len(numbers) != SPAN_SIZE or not 0 <= numbers[0] <= numbers[1]:
        raise ValueError(
            f"{what} must be a minimum and a maximum, such as [0.3, 0.6], got {_short(raw)}"
        )
    return float(numbers[0]), float(numbers[1])


def _check_name(what: str, name: Any, known: Iterable[str]) -> str:
    names = tuple(known)
    if name not in names:
        shown = ", ".join(names[:24])
        raise ValueError(f"{what} must be one of {shown}; got {_short(name)}")
    return str(name)


def _full_id(name: str) -> str:
    return name if ":" in name else f"minecraft:{name}"


def _table(keys: dict[str, Any], key: str) -> dict[str, Any]:
    return _mapping(key, keys.get(key, {}))


def _mapping(what: str, value: Any, known: Iterable[str] = ()) -> dict[str, Any]:
    if not isinstance(value, dict) or not all(isinstance(key, str) for key in value):
        raise ValueError(f"{what} must be a mapping with text keys, got {_short(value)}")
    names = tuple(known)
    strange = [key for key in value if names and key not in names]
    if strange:
        raise ValueError(
            f"{what} contains the unknown key {_short(strange[0])}; known keys: {', '.join(names)}"
        )
    if len(value) > MAX_NAMES or any(len(key) > MAX_NAME_LENGTH for key in value):
        raise ValueError(
            f"{what} may have at most {MAX_NAMES} keys of at most {MAX_NAME_LENGTH} characters each"
        )
    return value


def _list(what: str, value: Any) -> list[Any]:
    if not isinstance(value, list) or len(value) > MAX_NAMES:
        raise ValueError(
            f"{what} must be a list with at most {MAX_NAMES} items, got {_short(value)}"
        )
    return value


def _names(what: str, keys: dict[str, Any]) -> list[str]:
    listed = _list(what, keys.get(what, []))
    for one in listed:
        if not isinstance(one, str) or not 0 < len(one) <= MAX_NAME_LENGTH:
            raise ValueError(
                f"{what} must contain only names of 1 to {MAX_NAME_LENGTH} characters, "
                f"got {_short(one)}"
            )
    return listed


def _short(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."
