"""A free walk through a scene: a person walks and sees as agents do, with no task."""

from world2minecraft.navigation.browser_window import PATIENCE_S, Window, wait_for_move
from world2minecraft.navigation.moves import apply_move
from world2minecraft.navigation.scene import VlnScene, camera_of
from world2minecraft.navigation.types import Move

VIEW_PX, VIEW_FOV_DEG = (640, 480), 79.0  # RxR's camera, as runs have it.


def walk_freely(
    scene: VlnScene, window: Window, *, move_set: str = "vlnce", patience_s: float = PATIENCE_S
) -> None:
    """Walk where the keys say until nobody presses one; space leads back to the start.

    Raises:
        UsageError: nobody pressed a key for that long.
    """
    camera = camera_of(*VIEW_PX, VIEW_FOV_DEG)
    stance, collided = scene.start, False
    while True:
        seen = scene.picture(stance, camera, outputs=("colour",)).colour
        if seen is not None:
            window.show(seen, _caption(scene, stance.feet, collided))
        move = wait_for_move(window, patience_s)
        if move == Move.STOP:
            stance, collided = scene.start, False
        else:
            stance, collided = apply_move(scene, stance, move, move_set, sliding=True)


def _caption(scene: VlnScene, feet: tuple[float, float, float], collided: bool) -> str:
    room = scene.room_at(feet)
    name = scene.rooms[room].name if 0 <= room < len(scene.rooms) else "no room"
    return f"{scene.scene_id}, {name}" + (": something is in the way" if collided else "")
