"""The generator of ``web/src/commands.ts``, from the Python commands, queries and names.

``python -m world2minecraft.sceneforge.typescript`` writes the file. With ``--check`` it only
reports whether the file is up to date.
"""

import json
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import write_text
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.editing.scene import COMMANDS
from world2minecraft.sceneforge.queries import QUERIES

TARGET = Path(__file__).parent / "web" / "src" / "commands.ts"
HEAD = """\
// Made from core.classes, core.vocabulary, the commands of editing.scene and the queries of
// sceneforge by `python -m world2minecraft.sceneforge.typescript`; do not edit.
"""
PLAIN = {"integer": "number", "number": "number", "string": "string", "boolean": "boolean"}
WIDTH = 100
MAX_SPELLED = 4  # Longer arrays of one length are arrays like any other.


def main(words: Sequence[str]) -> int:
    """Write the file, or with ``--check`` return 1 if it is not up to date."""
    if "--check" in words:
        return int(not TARGET.is_file() or TARGET.read_text("utf-8") != typescript())
    write_text(TARGET, typescript())
    return 0


def typescript() -> str:
    """Return the contents of ``commands.ts``."""
    parts = [HEAD, _display_names(), _thing_names()]
    shared: dict[str, Any] = {}
    for models in (COMMANDS, QUERIES):
        for model in models.values():
            schema = model.model_json_schema()
            shared.update(schema.get("$defs", {}))
            parts.append(_interface(_name(model), schema))
    parts += [_interface(name, shared[name]) for name in sorted(shared)]
    parts.append(_union("Command", [model.__name__ for model in COMMANDS.values()]))
    parts.append(_fields_of("Queries", {name: _name(model) for name, model in QUERIES.items()}))
    return "\n".join(parts)


def _display_names() -> str:
    lines = "".join(f"  {json.dumps(name)},\n" for name in CLASS_DISPLAY_NAMES)
    comment = "/** Display name of each class, by id. */"
    return f"{comment}\nexport const CLASS_DISPLAY_NAMES: readonly string[] = [\n{lines}];\n"


def _thing_names() -> str:
    rows = [
        {"name": one.name, "title": one.title, "class_id": one.class_id, "labels": one.labels}
        for one in read_vocabulary().names.values()
    ]
    lines = "".join(f"  {json.dumps(row)},\n" for row in rows)
    fields = "{ name: string; title: string; class_id: number; labels: readonly string[] }"
    return (
        "/** The names of objects, with their synonyms. */\n"
        f"export const THING_NAMES: readonly {fields}[] = [\n{lines}];\n"
    )


def _name(model: type[BaseModel]) -> str:
    is_query = model in QUERIES.values()
    return f"{model.__name__}Query" if is_query else model.__name__


def _interface(name: str, schema: Mapping[str, Any]) -> str:
    """Return one type, in which fields with a default are optional, except a command's name."""
    if "properties" not in schema and schema.get("type") != "object":
        return f"{_comment(schema, '')}export type {name} = {_type(schema)};\n"
    required = {*schema.get("required", ()), "op"}
    lines = [
        f"{_comment(field, '  ')}  {key}{'' if key in required else '?'}: {_type(field)};\n"
        for key, field in schema.get("properties", {}).items()
    ]
    if not lines:
        return f"{_comment(schema, '')}export type {name} = Record<string, never>;\n"
    return f"{_comment(schema, '')}export interface {name} {{\n{''.join(lines)}}}\n"


def _type(schema: Mapping[str, Any]) -> str:
    """Return the TypeScript type for a JSON schema.

    Raises:
        World2MinecraftError: If the schema contains an unsupported feature.
    """
    if "$ref" in schema:
        return schema["$ref"].rpartition("/")[2]
    if "const" in schema:
        return json.dumps(schema["const"])
    if "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema["enum"])
    for together in ("anyOf", "oneOf"):
        if together in schema:
            return " | ".join(dict.fromkeys(_type(one) for one in schema[together]))
    kind = schema.get("type")
    if kind == "array":
        return _array(schema)
    if kind == "object":
        value = schema.get("additionalProperties", True)
        return f"Record<string, {_type(value) if isinstance(value, dict) else 'unknown'}>"
    if kind == "null":
        return "null"
    if kind in PLAIN:
        return PLAIN[kind]
    if kind is None:
        return "unknown"
    raise World2MinecraftError(
        f"cannot express this JSON schema in TypeScript: {json.dumps(schema)}"
    )


def _array(schema: Mapping[str, Any]) -> str:
    if "prefixItems" in schema:
        return f"[{', '.join(_type(item) for item in schema['prefixItems'])}]"
    item = _type(schema.get("items", {}))
    count = int(schema.get("maxItems", 0))
    if schema.get("minItems") == count and 0 < count <= MAX_SPELLED:
        return f"[{', '.join([item] * count)}]"
    return f"({item})[]" if " | " in item else f"{item}[]"


def _comment(schema: Mapping[str, Any], indent: str) -> str:
    """Return the first paragraph of a description as a comment, with the bounds of a number."""
    text = re.sub(r"\s+", " ", schema.get("description", "").split("\n\n")[0]).strip()
    bounds = _bounds(schema)
    text = f"{text} {bounds}".strip() if bounds else text
    if not text:
        return ""
    one = f"{indent}/** {text} */\n"
    if len(one) <= WIDTH:
        return one
    lines, line = [], f"{indent} *"
    for word in text.split(" "):
        if len(line) + 1 + len(word) > WIDTH:
            lines.append(line)
            line = f"{indent} *"
        line += f" {word}"
    return "\n".join([f"{indent}/**", *lines, line, f"{indent} */", ""])


def _bounds(schema: Mapping[str, Any]) -> str:
    signs = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<=", "exclusiveMaximum": "<"}
    return ", ".join(f"{sign} {schema[key]}" for key, sign in signs.items() if key in schema)


def _union(name: str, names: Sequence[str]) -> str:
    line = f"export type {name} = {' | '.join(names)};\n"
    return line if len(line) <= WIDTH else _long_union(name, names)


def _long_union(name: str, names: Sequence[str]) -> str:
    return f"export type {name} =\n" + "\n".join(f"  | {one}" for one in names) + ";\n"


def _fields_of(name: str, types: Mapping[str, str]) -> str:
    lines = "".join(f"  {key}: {kind};\n" for key, kind in types.items())
    return f"/** The fields of each query. */\nexport interface {name} {{\n{lines}}}\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
