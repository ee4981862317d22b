"""The parameters of a reconstruction: every key of ``settings`` with its meaning."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.core.parameters import ParameterInfo


def settings(prefix: str | None = None) -> "tuple[ParameterInfo, ...]":
    """List the keys that ``settings`` of other functions, and ``--set``, accept.

    Args:
        prefix: a group such as ``find``, or one key; all by default.

    Returns:
        For each its ``key``, ``default``, ``unit``, ``meaning`` and ``origin``.

    Raises:
        UnknownNameError: no key begins with ``prefix``; the message suggests the nearest.

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
