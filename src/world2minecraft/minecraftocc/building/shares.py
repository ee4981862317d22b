"""How the images of a split are shared, where some scenes have fewer views than others.

Every scene is asked for its share; what one cannot give is asked of those that gave all. The same
answers give the same shares, so a build that was broken off comes to the same.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace

from world2minecraft.minecraftocc.plan import SceneSpec

MOST_ROUNDS = 6
Look = Callable[[list[SceneSpec]], Iterable[int]]  # Gives how many views each scene has.


def shared_views(scenes: Iterable[SceneSpec], look: Look) -> list[SceneSpec]:
    """Return scenes with as many images as they have views, in their order.

    Args:
        scenes: of any splits, each with the images that it is asked for.
        look: called with scenes and how many images to ask each for; tells what they have.

    Returns:
        Of each split as many images as were asked for in all, or fewer where there are no more.
    """
    asked = {scene.scene_id: scene for scene in scenes}
    wanted = {scene.split: 0 for scene in asked.values()}
    for scene in asked.values():
        wanted[scene.split] += scene.images
    found: dict[str, int] = {}
    todo = list(asked.values())
    for _ in range(MOST_ROUNDS):
        views = look(todo)
        found |= {scene.scene_id: got for scene, got in zip(todo, views, strict=True)}
        todo = [one for split, count in wanted.items() for one in _more(asked, found, split, count)]
        asked |= {scene.scene_id: scene for scene in todo}
        if not todo:
            break
    return [replace(scene, images=found[scene.scene_id]) for scene in asked.values()]


def _more(
    asked: dict[str, SceneSpec], found: dict[str, int], split: str, wanted: int
) -> list[SceneSpec]:
    """Return the scenes of a split that may have more, with what to ask them for next."""
    mine = [scene for scene in asked.values() if scene.split == split]
    short = wanted - sum(found[scene.scene_id] for scene in mine)
    rich = [scene for scene in mine if found[scene.scene_id] >= scene.images]
    if short <= 0 or not rich:
        return []
    each, more = divmod(short, len(rich))
    return [
        replace(scene, images=scene.images + each + (number < more))
        for number, scene in enumerate(rich)
        if each + (number < more)
    ]
