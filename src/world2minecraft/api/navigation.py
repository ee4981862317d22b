"""MinecraftVLN: an environment to walk in, navigation data, agents and their scores."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of

if TYPE_CHECKING:
    import gymnasium


def make_env(scene: Run | str | Path, **options: Any) -> "gymnasium.Env":
    """Make the Gymnasium environment of a world.

    ``gymnasium.make("world2minecraft/MinecraftVLN-v0", scene=...)`` makes the same one.

    Args:
        scene: a run, its folder, a world or a block file.
        **options: those of ``navigation.environment.env.VlnEnv``, such as ``actions``,
            ``observations``, ``episodes`` and ``render_mode``; docs/vln-environment.md lists them.

    Raises:
        MissingExtraError: Gymnasium is not installed. UsageError: an option is wrong.
        InputError: the world cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> env = w2m.make_env(run, observations=("rgb", "pose"))
        >>> observation, info = env.reset(seed=1)
        >>> observation["rgb"].shape[2]
        3
    """
    from world2minecraft.navigation.environment import ENV_ID

    import gymnasium  # isort: skip  # An extra; the line above says so where it is missing.

    return gymnasium.make(ENV_ID, scene=path_of(scene), **options)
