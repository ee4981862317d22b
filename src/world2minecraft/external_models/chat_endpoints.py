"""Where models are served: a few known names, and any address that speaks the same protocol.

``gemini``, ``openai`` and ``qwen`` are clouds, each with its key in a variable of the environment;
``local`` is a server on this machine, such as vLLM's or LLaMA-Factory's. A model may follow a
name: ``gemini:gemini-3.5-flash-lite``.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from urllib.parse import urlsplit

from world2minecraft.core.errors import UnknownNameError, UsageError

NO_KEY = "none"  # The SDK wants a key, a server of one's own does not.


@dataclass(frozen=True)
class Endpoint:
    """A server and a model on it.

    ``key_name`` names the variable of the environment that holds the key, empty for none.
    ``length_name`` is what the server calls the most tokens of a reply.
    """

    url: str
    model: str = ""  # empty: the only one that the server has
    key_name: str = ""
    length_name: str = "max_tokens"

    def key(self, environment: Mapping[str, str] | None = None) -> str:
        """Return the key of the server. Raises UsageError where the variable is not set."""
        if not self.key_name:
            return NO_KEY
        key = (os.environ if environment is None else environment).get(self.key_name, "").strip()
        if not key:
            raise UsageError(
                f"{self.url} needs a key: export {self.key_name}=..., or name another variable "
                "with --key-env"
            )
        return key


ENDPOINTS = {
    "gemini": Endpoint(
        "https://generativelanguage.googleapis.com/v1beta/openai/",
        "gemini-3.8-flash",
        "GEMINI_API_KEY",
    ),
    "openai": Endpoint(
        "https://api.openai.com/v1", "gpt-4.1", "OPENAI_API_KEY", "max_completion_tokens"
    ),
    "qwen": Endpoint(
        "https://dashscope-intl.aliyuncs.com/compatible-mode/v1",
        "qwen3-vl-plus",
        "DASHSCOPE_API_KEY",
    ),
    "local": Endpoint("http://localhost:8000/v1"),
}


def is_endpoint(text: str) -> bool:
    """Return whether a text names a server: a known one, perhaps with a model, or an address.

    Example:
        >>> [is_endpoint(text) for text in ("gemini", "qwen:qwen-vl-max", "http://me/v1", "stop")]
        [True, True, True, False]
    """
    return "://" in text or text.partition(":")[0] in ENDPOINTS


def endpoint_of(text: str, *, model: str = "", key_name: str | None = None) -> Endpoint:
    """Return the server that a text names.

    Args:
        text: a known name, NAME:MODEL, or an address http(s)://HOST/v1.
        model: the model, where the text does not say it.
        key_name: the variable of the environment with the key, None for the usual one.

    Raises:
        UnknownNameError: no such name. UsageError: the address is none.

    Example:
        >>> endpoint_of("qwen:qwen-vl-max").model, endpoint_of("http://localhost:8000/v1").key_name
        ('qwen-vl-max', '')
    """
    if "://" in text:
        found = Endpoint(_checked(text))
    else:
        name, _, named = text.partition(":")
        if name not in ENDPOINTS:
            raise UnknownNameError("model server", name, ENDPOINTS)
        found = ENDPOINTS[name]
        found = replace(found, model=named or found.model)
    found = replace(found, model=model or found.model)
    return found if key_name is None else replace(found, key_name=key_name)


def _checked(address: str) -> str:
    try:
        parts = urlsplit(address)
        fine = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
        secret = parts.username or parts.password
    except ValueError:
        fine, secret = False, None
    if secret:
        raise UsageError("an address with a password in it is kept in records; use --key-env NAME")
    if not fine:
        raise UsageError(f"{address!r} is no address; one is http://localhost:8000/v1")
    return address.rstrip("/")
