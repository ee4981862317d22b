"""The table of all texture generators by name, which is used to parse recipes."""

from collections.abc import Mapping

from world2minecraft.rendering.textures import cloth, fittings, ground, plants, stone, wood
from world2minecraft.rendering.textures import furniture_faces as faces
from world2minecraft.rendering.textures import walls as wall
from world2minecraft.rendering.textures.generator import Accent, Generator
from world2minecraft.rendering.textures.recipe import Choice, Number

NO_YES, YES_NO = Choice(("0", "1")), Choice(("1", "0"))
STEM = Accent("stem", "#4b7a2e")
KNOB = Accent("knob", "#b9b4a6")
METAL_OR_WOOD = Choice(("wood", "metal"))

WALLS = {
    "plain": Generator(wall.plain, "#cfd3d4", options={"grain": Number(0.6, 0.0, 3.0)}),
    "plaster": Generator(wall.plaster, "#e2dccf"),
    "paper": Generator(
        wall.paper,
        "#cdd6c4?stripes=4",
        (Accent("stripes", 0.14),),
        {"stripes": Choice(("0", "1", "2", "4", "8"))},
    ),
    "polished": Generator(wall.polished, "#a5a7a8", tiles=False),
    "bricks": Generator(
        wall.brick_wall,
        "#96604f",
        (Accent("mortar", "#a79f97", 0.8),),
        {"rows": Choice(("4", "2", "8"))},
    ),
    "tiles": Generator(
        wall.tiles, "#d9dfe0", (Accent("grout", -0.25),), {"count": Choice(("2", "1", "4", "8"))}
    ),
}
WOODS = {
    "planks": Generator(
        wood.planks,
        "#a2824e",
        options={"boards": Choice(("4", "1", "2", "8")), "gaps": Choice(("dark", "light", "none"))},
    ),
    "parquet": Generator(wood.parquet, "#9c6b3f", options={"squares": Choice(("2", "4"))}),
    "bark": Generator(wood.bark, "#6b5231"),
    "grain": Generator(wood.grain, "#b08f56"),
    "rings": Generator(wood.rings, "#a88753", (Accent("bark", "#614a2b"),)),
    "crate": Generator(faces.crate, "#9b7748", (Accent("frame", -0.25),)),
}
STONES = {
    "stone": Generator(stone.stone, "#7d7d7d"),
    "speckled": Generator(stone.speckled, "#956755", (Accent("grains", 0.4),)),
    "cobble": Generator(
        stone.cobble,
        "#7f7f7f",
        (Accent("moss", "#5d7a35"),),
        {"stones": Choice(("4", "3", "6")), "moss": Number(0.0, 0.0, 1.0)},
    ),
    "ore": Generator(stone.ore, "#91856a", (Accent("nuggets", "#e0b24a"),)),
    "slate": Generator(stone.slate, "#505053"),
    "quartz": Generator(
        stone.quartz, "#ebe5de", options={"form": Choice(("block", "pillar"))}, tiles=False
    ),
    "obsidian": Generator(stone.obsidian, "#1a1226"),
    "netherrack": Generator(stone.netherrack, "#612626"),
    "prismarine": Generator(stone.prismarine, "#639c97", (Accent("veins", 0.35),)),
    "amethyst": Generator(stone.facets, "#8561bf"),
    "gem": Generator(
        stone.gem, "#62d6ce", options={"of": Choice(("mineral", "metal"))}, tiles=False
    ),
    "bone": Generator(stone.bone, "#d1ceb3"),
    "marble": Generator(stone.marble, "#dcdad6", (Accent("veins", -0.4),)),
}
GROUNDS = {
    "sand": Generator(ground.sand, "#dbcfa3"),
    "gravel": Generator(ground.gravel, "#837f7e"),
    "dirt": Generator(ground.dirt, "#866043"),
    "grass": Generator(ground.grass, "#6b9c47"),
    "grass_side": Generator(
        ground.grass_side, "#7f6a42", (Accent("turf", "#6b9c47"),), tiles=False
    ),
    "snow": Generator(ground.snow, "#f4f9fb"),
    "ice": Generator(ground.ice, "#92b7f5", options={"packed": NO_YES}, translucent=("packed=0",)),
    "water": Generator(ground.water, "#3f63c4", translucent=("*",)),
    "lava": Generator(ground.lava, "#d2591a", (Accent("bright", "#ffc23a"),)),
    "moss": Generator(ground.moss, "#596d2d"),
    "wart": Generator(ground.wart, "#732a2a"),
    "coral": Generator(ground.coral, "#cf5b9f"),
    "sponge": Generator(ground.sponge, "#c4c04b"),
    "honey": Generator(ground.honey, "#f5ae35", translucent=("*",)),
    "furrows": Generator(ground.furrows, "#6f4a2c"),
    "fire": Generator(
        ground.fire, "#d5802f", (Accent("heart", "#ffe27a"),), holes=("*",), tiles=False
    ),
}
CLOTHS = {
    "wool": Generator(cloth.wool, "#a12722"),
    "carpet": Generator(cloth.carpet, "#3a6b8c"),
    "leather": Generator(cloth.leather, "#7a4a2c", options={"buttons": NO_YES}),
    "bed_top": Generator(
        cloth.bed_top,
        "#b4403a",
        (Accent("pillow", "#f4f2ee", 0.75),),
        {"part": Choice(("head", "foot"))},
        tiles=False,
    ),
    "drape": Generator(cloth.drape, "#7b4a68"),
    "straw": Generator(cloth.straw, "#a68b26", (Accent("band", "#9a3a2a"),), {"band": YES_NO}),
}
FITTINGS = {
    "metal": Generator(fittings.metal, "#c4c6c8", options={"frame": NO_YES}),
    "copper": Generator(
        fittings.copper,
        "#c06c50",
        (Accent("verdigris", "#52a384"),),
        {"verdigris": Number(0.0, 0.0, 1.0)},
    ),
    "screen": Generator(
        fittings.screen,
        "#15181c",
        (Accent("frame", "#2b2d30"),),
        {"on": NO_YES, "frame": YES_NO},
    ),
    "lamp": Generator(
        fittings.lamp,
        "#d9a85f",
        (Accent("lattice", "#5b3a22", 0.8),),
        {"lit": YES_NO, "panes": Choice(("2", "1", "4"))},
    ),
    "glow": Generator(fittings.glow, "#ac8354", (Accent("crystals", "#fff2b8"),)),
    "bars": Generator(
        fittings.bars, "#8b8d8c", options={"count": Choice(("4", "2"))}, holes=("*",)
    ),
    "lattice": Generator(
        fittings.lattice,
        "#7c6036",
        options={"holes": Choice(("2", "4", "1")), "of": METAL_OR_WOOD},
        holes=("*",),
    ),
    "chain": Generator(fittings.chain, "#3b414e", holes=("*",)),
    "rail": Generator(fittings.rail, "#7d6f58", (Accent("sleepers", "#7d5f3b"),), holes=("*",)),
}
OPENINGS = {
    "glass": Generator(
        fittings.glass,
        "#d2e8ee",
        options={"stained": NO_YES},
        translucent=("*",),
    ),
    "door": Generator(
        fittings.door,
        "#8f7144",
        (KNOB,),
        {"half": Choice(("upper", "lower")), "panes": Choice(("0", "2", "4"))},
        holes=("panes=2", "panes=4"),
        tiles=False,
    ),
    "ladder": Generator(fittings.ladder, "#7d613a", holes=("*",)),
}
PLANTS = {
    "leaves": Generator(
        plants.leaves,
        "#4d7a2c",
        (Accent("blossoms", "#e8a9cf"),),
        {"holes": YES_NO, "blossom": NO_YES},
        holes=("holes=1",),
    ),
    "blades": Generator(
        plants.blades,
        "#6a9a41",
        (Accent("ears", "#cdb04e"),),
        {"kind": Choice(tuple(plants.BLADES)), "ears": Number(0.0, 0.0, 1.0)},
        holes=("*",),
        tiles=False,
    ),
    "flower": Generator(
        plants.flower,
        "#874a2b",
        (STEM, Accent("heart", "#e8c33c")),
        {"shape": Choice(tuple(plants.FLOWERS))},
        holes=("*",),
        tiles=False,
    ),
    "sapling": Generator(
        plants.sapling,
        "#4f7a34",
        (Accent("trunk", "#6b4c2a"),),
        {"shape": Choice(tuple(plants.SAPLINGS))},
        holes=("*",),
        tiles=False,
    ),
    "mushroom": Generator(
        plants.mushroom, "#c45a4c", (Accent("stem", "#ddd3c3"),), holes=("*",), tiles=False
    ),
    "vine": Generator(plants.vine, "#3f6b24", holes=("*",)),
    "gourd": Generator(
        plants.gourd,
        "#c77a22",
        (Accent("thorns", "#e3e0c0"),),
        {"ribs": Choice(("4", "2", "8")), "thorns": NO_YES},
    ),
    "mushroom_cap": Generator(plants.mushroom_cap, "#b53a32", (Accent("spots", "#e6d9c8"),)),
    "pad": Generator(plants.pad, "#2f7a36", holes=("*",), tiles=False),
    "web": Generator(plants.web, "#e4e9ea", holes=("*",), tiles=False),
    "crystal": Generator(plants.crystal, "#a47fd0", holes=("*",), tiles=False),
}
FACES = {
    "books": Generator(
        faces.books,
        "#76613e",
        (
            Accent("first spines", "#963c2e"),
            Accent("second", "#3a4f72"),
            Accent("third", "#52682e"),
            Accent("fourth", "#b08c4c"),
            Accent("boards", 0.2),
        ),
    ),
    "drawers": Generator(
        faces.drawers,
        "#9a7442",
        (KNOB,),
        {"kind": Choice(("three", "two", "doors", "chest", "barrel"))},
    ),
    "table_top": Generator(faces.table_top, "#8f6a43", (Accent("frame", -0.3),)),
    "furnace_front": Generator(
        faces.furnace_front, "#6b6a69", (Accent("fire", "#f2a33a"),), {"lit": NO_YES}
    ),
    "face": Generator(faces.face, "#b8701f", (Accent("light", "#f6d75a"),), {"lit": NO_YES}),
    "cake": Generator(
        faces.cake,
        "#ecd9cc",
        (Accent("berries", "#c23a35"), Accent("sponge", "#b5763f")),
        {"part": Choice(("top", "side"))},
        tiles=False,
    ),
    "painting": Generator(
        faces.painting,
        "#9aa7a0",
        (
            Accent("frame", "#6b4a2a"),
            Accent("back", "#6f8a4a"),
            Accent("front", "#4f6a3a"),
            Accent("spot", "#e6d28a"),
        ),
        {"motif": Choice(faces.MOTIFS)},
        tiles=False,
    ),
    "glazed": Generator(
        faces.glazed,
        "#3f86a8",
        (Accent("ring", "#e9e4d4"), Accent("petals", "#26415e")),
        tiles=False,
    ),
}
GROUPS: Mapping[str, Mapping[str, Generator]] = {
    "Walls": WALLS,
    "Wood": WOODS,
    "Stone": STONES,
    "Ground": GROUNDS,
    "Cloth": CLOTHS,
    "Metal and light": FITTINGS,
    "Openings": OPENINGS,
    "Plants": PLANTS,
    "Faces": FACES,
}
GENERATORS: Mapping[str, Generator] = {
    name: generator for group in GROUPS.values() for name, generator in group.items()
}
