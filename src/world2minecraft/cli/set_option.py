"""How ``--set KEY=VALUE`` is read for the functions of the public API."""

from collections.abc import Sequence

from world2minecraft.core.errors import UsageError


def read_settings(words: Sequence[str] | None) -> dict[str, str]:
    """Return the settings of ``--set`` by their keys; the last of one key wins.

    Raises:
        UsageError: one is not ``KEY=VALUE``.

    Example:
        >>> read_settings(["build.ceiling=glass"])
        {'build.ceiling': 'glass'}
    """
    settings = {}
    for word in words or ():
        key, equals, value = word.partition("=")
        if not equals:
            raise UsageError(f"--set needs KEY=VALUE, such as find.cluster_radius=3, not {word!r}")
        settings[key.strip()] = value.strip()
    return settings
