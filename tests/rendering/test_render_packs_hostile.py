"""Packs that are broken or traps: a whole one is refused in a sentence, a file falls through."""

import json
import os
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pack_making import (
    BLOCK,
    CUBE,
    MODEL,
    PICTURE,
    block_files,
    content,
    cube_files,
    folder_pack,
    one_model,
    plain,
    zip_pack,
)

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.rendering.resource_packs import ResourcePackModels
from world2minecraft.rendering.resource_packs import pack_files as archive
from world2minecraft.rendering.resource_packs import pack_files as resources

RED = plain(200, 0, 0)
TEACHES = (
    "a pack is a folder, zip or jar that contains assets/minecraft/textures, models or "
    "blockstates, such as resourcepacks/MyPack.zip or versions/1.21.4/1.21.4.jar"
)


def refusal(path, kind: type[InputError] = DamagedFileError) -> str:
    with pytest.raises(kind) as caught:
        ResourcePackModels([path])
    assert type(caught.value) is kind
    return caught.value.reason


def problem(tmp_path, files, state="minecraft:thing") -> str:
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    assert looks.model(state) is None
    assert looks.problem_count == len(looks.problems) == 1
    told = "1 problem in the resource packs, first: " + looks.problems[0]
    assert looks.summary == told
    return looks.problems[0]


def test_nothing_there(tmp_path):
    assert refusal(tmp_path / "no.zip", InputError) == f"not found; {TEACHES}"


def test_no_pack(tmp_path):
    (tmp_path / "empty").mkdir()
    assert refusal(tmp_path / "empty") == f"not a resource pack; {TEACHES}"
    zip_pack(tmp_path / "a.zip", {"readme.txt": b"hello"})
    assert refusal(tmp_path / "a.zip") == f"not a resource pack; {TEACHES}"


def test_no_zip(tmp_path):
    (tmp_path / "a.zip").write_bytes(b"hello" * 50)
    said = "not a readable zip file (end-of-archive record not found)"
    assert refusal(tmp_path / "a.zip") == said


def test_a_folder_of_packs_names_one(tmp_path):
    zip_pack(tmp_path / "Nice.zip", cube_files("stone", RED))
    said = refusal(tmp_path)
    assert said.startswith(
        f"not a resource pack, but contains 1: use one, such as {tmp_path / 'Nice.zip'}; a pack is"
    )
    folder_pack(tmp_path / "b" / "inner", cube_files("stone", RED))
    said = refusal(tmp_path / "b")
    assert said.startswith(
        f"not a resource pack, but contains one: use {tmp_path / 'b' / 'inner'}; a pack"
    )


def test_packs_of_other_kinds_are_told_apart(tmp_path):
    folder_pack(tmp_path / "data_pack", {"data/minecraft/tags/a.json": {}})
    assert refusal(tmp_path / "data_pack").startswith("not a resource pack, but a data pack; ")
    folder_pack(tmp_path / "bedrock", {"manifest.json": {}, "textures/blocks/stone.png": RED})
    assert refusal(tmp_path / "bedrock").startswith("not a resource pack, but a pack for Bedrock")


def test_a_zip_with_its_folder_around_it_is_read(tmp_path):
    files = {f"MyPack/{name}": value for name, value in cube_files("stone", RED).items()}
    assert ResourcePackModels([zip_pack(tmp_path / "a.zip", files)]).model("stone") is not None


def test_a_zip_that_lists_too_much_is_refused_unread(tmp_path):
    path = zip_pack(tmp_path / "a.zip", cube_files("stone", RED))
    data = bytearray(path.read_bytes())
    at = data.rfind(b"PK\x05\x06")
    data[at + 12 : at + 16] = (archive.MAX_DIRECTORY_BYTES + 1).to_bytes(4, "little")
    path.write_bytes(data)
    assert refusal(path, LimitError) == "contains more than 400,000 files, which is the limit"


def test_a_large_zip_that_lists_too_much_is_refused_unread(tmp_path):
    """Zips of over 65,535 files say their sizes in a second record, before the first."""
    path = zip_pack(tmp_path / "a.zip", cube_files("stone", RED))
    data = path.read_bytes()
    at = data.rfind(b"PK\x05\x06")
    most = (archive.MAX_DIRECTORY_BYTES + 1).to_bytes(8, "little")
    record = b"PK\x06\x06" + bytes(36) + most + bytes(8)
    locator = b"PK\x06\x07" + bytes(4) + at.to_bytes(8, "little") + bytes(4)
    path.write_bytes(data[:at] + record + locator + data[at:])
    assert refusal(path, LimitError) == "contains more than 400,000 files, which is the limit"


def test_too_many_files_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(archive, "MAX_FILES", 2)
    path = zip_pack(tmp_path / "a.zip", cube_files("stone", RED))
    assert refusal(path, LimitError) == "contains 3 files, the limit is 2"
    folder = folder_pack(tmp_path / "b", cube_files("stone", RED))
    said = "contains more than 2 files; give the path of a single pack in it"
    assert refusal(folder, LimitError) == said


def test_a_bomb_is_not_unpacked(tmp_path):
    files = cube_files("thing", RED)
    files[MODEL.format("thing")] = b" " * (3 << 20)
    looks = ResourcePackModels([zip_pack(tmp_path / "a.zip", files)])
    assert looks.model("thing") is None
    assert looks.problems[0].startswith(
        "assets/minecraft/models/block/thing.json of a.zip: compression ratio "
    )
    files[MODEL.format("thing")] = b" " * (5 << 20)
    looks = ResourcePackModels([zip_pack(tmp_path / "b.zip", files)])
    assert looks.model("thing") is None
    assert looks.problems[0].endswith("file has 5,242,880 bytes, the limit is 4,194,304")


def test_a_damaged_member_falls_through(tmp_path):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w") as stored:
        for name, value in cube_files("thing", RED).items():
            stored.writestr(name, content(value))
    data = path.read_bytes()
    path.write_bytes(data.replace(b'"elements"', b'"elementz"', 1))
    looks = ResourcePackModels([path])
    assert looks.model("thing") is None
    assert "cannot be unpacked (Bad CRC-32" in looks.problems[0]


def test_names_never_lead_out_of_a_pack(tmp_path):
    (tmp_path / "secret.png").write_bytes(content(RED))
    for name in ("../../../../secret", "minecraft:../../../../secret", "/etc/passwd", "a\\b"):
        model = {**CUBE, "textures": {"all": name}}
        said = problem(tmp_path, block_files("thing", one_model("thing"), model))
        assert said == (
            "minecraft:thing: texture must be a resource name such as minecraft:block/stone, "
            f"got {name!r}"
        )


def test_names_in_a_zip_are_only_keys(tmp_path):
    files = cube_files("thing", RED) | {"../assets/minecraft/blockstates/evil.json": {}}
    looks = ResourcePackModels([zip_pack(tmp_path / "a.zip", files)])
    assert looks.model("thing") is not None
    assert looks.model("evil") is None


def test_links_and_pipes_in_a_folder_are_left_out(tmp_path):
    secret = tmp_path / "secret.png"
    secret.write_bytes(content(RED))
    pack = folder_pack(tmp_path / "pack", cube_files("stone", RED))
    (pack / PICTURE.format("linked")).symlink_to(secret)
    if hasattr(os, "mkfifo"):
        os.mkfifo(pack / PICTURE.format("endless"))
    for name in ("linked", "endless"):
        assert ResourcePackModels([pack]).texture(f"minecraft:block/{name}") is None


def test_a_broken_file_falls_through_to_the_pack_below(tmp_path):
    good = folder_pack(tmp_path / "good", cube_files("thing", RED))
    bad = {BLOCK.format("thing"): b"{,", PICTURE.format("thing"): b"\x89PNG"}
    looks = ResourcePackModels([good, folder_pack(tmp_path / "bad", bad)])
    assert looks.model("thing") is not None
    assert looks.problem_count == 2
    assert looks.problems[0].startswith(
        "assets/minecraft/blockstates/thing.json of bad: invalid JSON (Expecting"
    )
    assert looks.problems[1] == "assets/minecraft/textures/block/thing.png of bad: not a PNG file"


def test_a_missing_texture_leaves_the_block_to_the_next_source(tmp_path):
    files = cube_files("thing", RED)
    del files[PICTURE.format("thing")]
    assert problem(tmp_path, files) == (
        "minecraft:thing: texture minecraft:block/thing not found in the packs or not readable"
    )


BOX = {"from": [0, 0, 0], "to": [16, 16, 16]}


def element(**changes) -> dict:
    face = {"up": {"texture": "#all"}}
    return {"elements": [{**BOX, "faces": face, **changes}], "textures": {"all": "block/thing"}}


@pytest.mark.parametrize(
    ("model", "text"),
    [
        ({"parent": "block/thing"}, "model block/thing is its own parent"),
        ({"parent": "block/no"}, "model minecraft:block/no (parent of block/thing) not found"),
        ({"parent": 7}, "parent must be a string, got 7"),
        ({"loader": "forge:obj"}, "model block/thing uses a mod's own format, which is not"),
        ({"textures": []}, "textures must be an object, got a list"),
        ({"elements": {"a": 1}}, "elements must be a list, got an object"),
        ({"elements": [1]}, "an element must be an object, got 1"),
        (element(**{"from": None}), "from must be a list, got None"),
        (element(to=[1, 2]), "to must have 3 numbers, got 2"),
        (element(to=[1, 2, 99]), "to must be -16 to 32, got 99"),
        (element(to=[1, 2, True]), "to must be a number, got True"),
        (element(to=[1, 2, 10**400]), "to must be a finite number"),
        (element(faces=[]), "faces must be an object, got a list"),
        (element(faces={"up": 1}), "face up must be an object, got 1"),
        (element(faces={"up": {}}), "texture of a face must be a string, got None"),
        (element(faces={"up": {"texture": "#no"}}), "texture #no is not set"),
        (element(faces={"up": {"texture": "#all", "uv": [0]}}), "uv must have 4 numbers, got 1"),
        (
            element(faces={"up": {"texture": "#all", "rotation": 45}}),
            "rotation of a face must be a multiple of 90, got 45",
        ),
        (element(rotation=3), "rotation must be an object, got 3"),
        (element(rotation={"axis": "w"}), "axis of a rotation must be x, y or z, got 'w'"),
        (element(light_emission=99), "light_emission must be 0 to 15, got 99"),
    ],
)
def test_a_broken_model_is_said(tmp_path, model, text):
    files = block_files("thing", {"variants": {"": {"model": "block/thing"}}}, model, thing=RED)
    assert problem(tmp_path, files).startswith(f"minecraft:thing: {text}")


def test_texture_keys_in_a_circle(tmp_path):
    model = {**CUBE, "textures": {"all": "#a", "a": "#b", "b": "#a"}}
    said = problem(tmp_path, block_files("thing", one_model("thing"), model))
    assert said == "minecraft:thing: texture #a refers to itself"


def test_parents_without_end(tmp_path):
    files = block_files("thing", one_model("0"), None)
    for index in range(60):
        files[MODEL.format(index)] = {"parent": f"block/{index + 1}"}
    assert problem(tmp_path, files).endswith("has more than 32 parents")


def test_deep_json(tmp_path):
    files = cube_files("thing", RED) | {BLOCK.format("thing"): b"[" * 200_000}
    assert "invalid JSON (" in problem(tmp_path, files)


def test_too_many_elements(tmp_path):
    model = {**CUBE, "elements": CUBE["elements"] * 2049, "textures": {"all": "block/thing"}}
    said = problem(tmp_path, block_files("thing", one_model("thing"), model, thing=RED))
    assert said == "minecraft:thing: elements has 2,049 items, the limit is 2,048"


def test_parts_and_blocks_without_end(tmp_path, monkeypatch):
    model = {**CUBE, "elements": CUBE["elements"] * 900, "textures": {"all": "block/thing"}}
    parts = {"multipart": [{"apply": {"model": "block/thing"}}] * 3}
    files = block_files("thing", parts, model, thing=RED)
    assert problem(tmp_path / "a", files) == (
        "minecraft:thing: the models have more than 2,048 elements in total"
    )
    monkeypatch.setattr(
        "world2minecraft.rendering.resource_packs.pack_models.MAX_TOTAL_ELEMENTS", 0
    )
    assert problem(tmp_path / "b", cube_files("thing", RED)) == (
        "minecraft:thing: the packs exceed the limit of 0 elements in total"
    )
    monkeypatch.setattr(resources, "MAX_TOTAL_JSON_BYTES", 9)
    assert "more than 9 bytes of JSON" in problem(tmp_path / "c", cube_files("thing", RED))


def test_problems_are_counted_and_only_some_are_kept(tmp_path):
    files = {BLOCK.format(f"thing_{index}"): b"no" for index in range(70)}
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    for _ in range(2):
        assert all(looks.model(f"thing_{index}") is None for index in range(70))
    assert looks.problem_count == 70
    assert len(looks.problems) == resources.MAX_PROBLEMS
    assert looks.summary.startswith(
        "70 problems in the resource packs, first: assets/minecraft/blockstates/thing_0"
    )


def test_nothing_is_said_of_a_good_pack(tmp_path):
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", cube_files("stone", RED))])
    assert looks.model("stone") is not None
    assert (looks.summary, looks.problems) == ("", [])


@pytest.mark.parametrize(
    "meta", [b"no", {"overlays": 3}, {"overlays": {"entries": [{"directory": "../up"}]}}]
)
def test_a_broken_description_does_not_lose_the_pack(tmp_path, meta):
    files = cube_files("stone", RED) | {"pack.mcmeta": meta}
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    assert looks.model("stone") is not None
    assert looks.problem_count == 1


KEYS = (
    *("variants", "multipart", "when", "apply", "OR", "AND", "model", "parent", "textures"),
    *("elements", "from", "to", "faces", "up", "texture", "uv", "rotation", "axis", "angle"),
    *("origin", "all", "x", "y", "z", "weight", "animation", "frames", "a=b"),
)
ANY = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**12), 10**12)
    | st.floats()
    | st.sampled_from(["#all", "block/thing", "x", "", "a=b", "up", "builtin/entity"]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(KEYS),
            inner,
            max_size=5,
        )
    ),
    max_leaves=30,
)


@given(state=ANY, model=ANY, meta=ANY)
def test_values_of_any_kind_never_escape_as_errors(tmp_path_factory, state, model, meta):
    mixed = {**element(), **(model if isinstance(model, dict) else {})}
    variants = {"variants": {"": state}} if not isinstance(state, dict) else state
    files = {
        BLOCK.format("thing"): json.dumps(variants).encode(),
        BLOCK.format("other"): one_model("thing"),
        MODEL.format("thing"): json.dumps(mixed).encode(),
        PICTURE.format("thing"): RED,
        PICTURE.format("thing") + ".mcmeta": json.dumps({"animation": meta}).encode(),
        "pack.mcmeta": json.dumps({"overlays": meta}).encode(),
    }
    looks = ResourcePackModels([folder_pack(tmp_path_factory.mktemp("pack"), files)])
    for name in ("thing", "other"):
        model = looks.model(name)
        assert model is None or model.elements


@given(data=st.binary(max_size=200))
def test_bytes_of_any_kind_never_escape_as_errors(tmp_path_factory, data):
    files = cube_files("thing", RED)
    at = len(data) % 40 + 10
    broken = content(RED)[:at] + data
    path = tmp_path_factory.mktemp("pack")
    files |= {PICTURE.format("thing"): broken, BLOCK.format("other"): data}
    looks = ResourcePackModels([folder_pack(path / "a", files)])
    looks.model("thing")
    looks.model("other")
    (path / "b.zip").write_bytes(data + b"PK\x05\x06" + data)
    with pytest.raises(InputError):
        ResourcePackModels([path / "b.zip"])
