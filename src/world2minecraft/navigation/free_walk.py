"""A free walk in the browser, with the same movement and view as agents but without a task."""

from world2minecraft.navigation.browser_window import PATIENCE_S, Window, wait_for_move
from world2minecraft.navigation.moves import apply_move
from world2minecraft.navigation.running.simulator import VIEW_FOV_DEG, VIEW_PX
from world2minecraft.navigation.scene import VlnScene, camera_of
from world2minecraft.navigation.types import Move


def walk_freely(scene: VlnScene, window: Window, *, patience_s: float = PATIENCE_S) -> None:
    """Let a person walk through a scene with the keyboard. The space key returns to the start.

    Args:
        scene: The scene.
        window: The page that shows the view and receives the keys.
        patience_s: Seconds to wait for each key press.

    Raises:
        UsageError: If no key is pressed in time, which ends the walk.
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
            stance, collided = apply_move(scene, stance, move, sliding=True)


def _caption(scene: VlnScene, feet: tuple[float, float, float], collided: bool) -> str:
    room = scene.room_at(feet)
    name = scene.rooms[room].name if 0 <= room < len(scene.rooms) else "outside all rooms"
    return f"{scene.scene_id}, {name}" + (": blocked by an obstacle" if collided else "")
