"""Planning the views of a generated house, and its walkable graph: CPU time."""

import time
from collections.abc import Callable
from typing import Any

from benchmarks.rows import Row
from world2minecraft.minecraft.physics.shortest_paths import distances_m
from world2minecraft.minecraft.physics.walk_graph import walk_graph
from world2minecraft.minecraftocc.tours import plan_views
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import prepare_scene

FEW, MANY = 100, 640  # 640 a house are 100,000 of 156 houses.
BUDGET_MS = 10.0


def run() -> list[Row]:
    """Measure in one house of six rooms, after one plan that compiles."""
    volume = generate_world(5, rooms=6).volume
    scene = prepare_scene(volume)
    plan_views(volume, 20, scene=scene)
    graph = walk_graph(volume)
    distances_m(graph, 0)
    rows = [
        Row(
            f"a view, {count} of a house",
            round(_ms(lambda count=count: plan_views(volume, count, scene=scene)) / count, 2),
            "ms",
            BUDGET_MS,
        )
        for count in (FEW, MANY)
    ]
    found = round(_ms(lambda: walk_graph(volume)), 1)
    rows.append(Row("the walkable graph of a house", found, "ms"))
    rows.append(Row("all distances to a place", round(_ms(lambda: distances_m(graph, 0)), 2), "ms"))
    return rows


def _ms(act: Callable[[], Any]) -> float:
    begun = time.process_time()
    act()
    return (time.process_time() - begun) * 1000
