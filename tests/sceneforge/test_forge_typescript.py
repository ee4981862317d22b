"""The page's types of commands and queries are those of Python."""

from typing import Annotated, Literal

import pytest
from pydantic import BaseModel, Field

from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.editing.scene import COMMANDS
from world2minecraft.sceneforge import typescript
from world2minecraft.sceneforge.queries import QUERIES


class Part(BaseModel):
    name: str


class Every(BaseModel):
    """One of each kind of field.

    A second paragraph stays in Python.
    """

    op: Literal["every"] = "every"
    count: Annotated[int, Field(ge=0, lt=9)]
    at_m: tuple[float, float, float]
    runs: list[tuple[int, int]] = []
    ids: tuple[int, ...] = ()
    to: Literal["floor", "wall"] = "floor"
    maybe: str | None = None
    mixed: list[int | str] = []
    parts: list[Part] = []
    shares: dict[str, float] = {}
    anything: dict[str, object] = {}
    exact: Annotated[list[int], Field(min_length=2, max_length=2)] = [1, 2]


EVERY = """\
/** One of each kind of field. */
export interface Every {
  op: "every";
  /** >= 0, < 9 */
  count: number;
  at_m: [number, number, number];
  runs?: [number, number][];
  ids?: number[];
  to?: "floor" | "wall";
  maybe?: string | null;
  mixed?: (number | string)[];
  parts?: Part[];
  shares?: Record<string, number>;
  anything?: Record<string, unknown>;
  exact?: [number, number];
}
"""


def test_the_file_is_what_the_classes_say():
    stale = "is stale: run python -m world2minecraft.sceneforge.typescript"
    assert typescript.main(["--check"]) == 0, f"{typescript.TARGET.name} {stale}"


def test_each_kind_of_field_has_its_type():
    assert typescript._interface("Every", Every.model_json_schema()) == EVERY


def test_a_schema_that_is_not_known_is_refused():
    with pytest.raises(World2MinecraftError, match="cannot express this JSON schema in TypeScript"):
        typescript._type({"type": "unheard"})


def test_every_command_and_query_is_named():
    text = typescript.typescript()
    for model in COMMANDS.values():
        assert f"export interface {model.__name__} " in text
    for name in QUERIES:
        assert f"  {name}: {QUERIES[name].__name__}Query;" in text


def test_a_stale_file_is_seen_and_mended(tmp_path, monkeypatch):
    monkeypatch.setattr(typescript, "TARGET", tmp_path / "commands.ts")
    assert typescript.main(["--check"]) == 1
    assert typescript.main([]) == 0
    assert typescript.main(["--check"]) == 0
    (tmp_path / "commands.ts").write_text("")
    assert typescript.main(["--check"]) == 1
