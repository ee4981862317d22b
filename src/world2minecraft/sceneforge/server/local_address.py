"""The addresses of this machine: on its local network, and those that only it reaches."""

import socket
from collections.abc import Iterable
from contextlib import suppress
from ipaddress import IPv6Address, ip_address

from world2minecraft.core.errors import UsageError

# Documentation addresses (RFC 5737): asking for the way to one sends nothing.
FAR_AWAY = ("192.0.2.1", 9)


def is_loopback(host: str) -> bool:
    """Return whether an address or a name means this machine itself.

    Example:
        >>> is_loopback("::ffff:127.0.0.1")  # As a server of both kinds of addresses sees it.
        True
    """
    if host == "localhost":
        return True
    try:
        address = ip_address(host)
    except ValueError:
        return False
    if isinstance(address, IPv6Address) and address.ipv4_mapped is not None:
        address = address.ipv4_mapped
    return address.is_loopback


def lan_address() -> str:
    """Return the IPv4 address under which phones of the local network reach this machine.

    Raises:
        UsageError: If this machine has no such address.
    """
    return choose_address(own_addresses())


def own_addresses() -> list[str]:
    """Return IPv4 addresses of this machine, first the one of the default route."""
    found = []
    with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect(FAR_AWAY)
        found.append(str(probe.getsockname()[0]))
    with suppress(OSError):
        named = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
        found += [str(address[0]) for *_, address in named]
    return list(dict.fromkeys(found))


def choose_address(found: Iterable[str]) -> str:
    """Return the first address of a local network, which the internet does not reach.

    Raises:
        UsageError: If there is none.

    Example:
        >>> choose_address(["127.0.0.1", "192.168.1.5"])
        '192.168.1.5'
    """
    for text in found:
        address = ip_address(text)
        is_here = address.is_loopback or address.is_link_local or address.is_unspecified
        if not is_here and not address.is_global:
            return text
    raise UsageError(
        "--phone found no local network; join the Wi-Fi of the phone, or name this machine's "
        "address with --host ADDRESS"
    )
