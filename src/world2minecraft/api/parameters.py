"""List the parameters of a reconstruction, which are the keys of ``settings``."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.core.parameters import ParameterInfo


def settings(prefix: str | None = None) -> "tuple[ParameterInfo, ...]":
    """List the keys accepted by the ``settings`` argument of other functions and by ``--set``.

    Args:
        prefix: A group such as ``find``, or a single key. Defaults to all keys.

    Returns:
        One entry per parameter with its ``key``, ``default``, ``unit``, ``meaning`` and ``origin``.

    Raises:
        UnknownNameError: If no key starts with ``prefix``. The message suggests the closest match.

    Example:
        >>> import world2minecraft as w2m
        >>> [one.key for one in w2m.settings("clean")]
        ['clean.floater_cells', 'clean.hole_m']
    """
    from world2minecraft.core.errors import UnknownNameError
    from world2minecraft.core.parameters import describe_parameters
    from world2minecraft.reconstruction.parameters import Parameters, parameter_keys

    accepted = set(parameter_keys())
    known = tuple(one for one in describe_parameters(Parameters) if one.key in accepted)
    if prefix is None:
        return known
    start = prefix.rstrip(".")
    found = tuple(one for one in known if f"{one.key}.".startswith(f"{start}."))
    if not found:
        groups = dict.fromkeys(one.key.partition(".")[0] for one in known if "." in one.key)
        raise UnknownNameError("setting", prefix, [*groups, *(one.key for one in known)])
    return found
