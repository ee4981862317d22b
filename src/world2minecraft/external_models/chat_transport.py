"""Transport to a chat server through the openai SDK, with limits on time and size.

``gemini``, ``openai`` and ``qwen`` are cloud services whose API keys are read from environment
variables. ``local`` is a server on this machine, such as vLLM or LLaMA-Factory. A name can be
followed by a model, as in ``gemini:gemini-3.5-flash-lite``. The address of any compatible server
works as well.

Servers are not trusted to reply in time, in reasonable size, or in the correct format. A reply is
therefore read in pieces up to the limits, and the type of every value is checked. Errors are
classified by what the caller can do: ask again later (``BusyServerError``), ask differently
(``RefusedQuestionError``), or discard the reply (``UselessReplyError``). Invalid keys and addresses
raise a plain ``ServerError``. Each error states whether the call may be billed (``may_cost``), and
never contains the API key.
"""

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any
from urllib.parse import urlsplit

from world2minecraft.core.errors import MissingExtraError, ServerError, UnknownNameError, UsageError
from world2minecraft.external_models.chat_costs import CHARACTERS_PER_TOKEN, estimate_tokens
from world2minecraft.external_models.chat_messages import Question, Reply

NO_KEY = "none"  # The SDK requires a key, even for local servers.
MAX_REPLY_BYTES = 256 << 10  # 1,024 tokens are about 4 KiB.
MAX_EXCERPT = 300  # Characters of a server's own message in an error.
MAX_TOKENS_COUNTED = 10_000_000
BUSY = (408, 409, 425, 429, 500, 502, 503, 504, 529)
REFUSED = (400, 413, 415, 422, 501)
UNSENT = ("ConnectError", "ConnectTimeout", "PoolTimeout")  # Of httpx, whose name SDKs change.


@dataclass(frozen=True)
class Endpoint:
    """A server and a model on it.

    Attributes:
        url: The base URL of the API.
        model: The model name. Empty selects the only model of the server.
        key_name: The environment variable that contains the API key, or "".
        length_name: The API parameter for the maximum number of tokens of a reply.
    """

    url: str
    model: str = ""  # empty: the only one that the server has
    key_name: str = ""
    length_name: str = "max_tokens"

    def key(self, environment: Mapping[str, str] | None = None) -> str:
        """Return the API key of the server.

        Raises:
            UsageError: If the environment variable is not set.
        """
        if not self.key_name:
            return NO_KEY
        key = (os.environ if environment is None else environment).get(self.key_name, "").strip()
        if not key:
            raise UsageError(
                f"{self.url} requires an API key: export {self.key_name}=..., or name another "
                "environment variable (--key-env)"
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
    """Return whether a text is a known server, optionally with a model, or an address.

    Example:
        >>> [is_endpoint(text) for text in ("gemini", "qwen:qwen-vl-max", "http://me/v1", "stop")]
        [True, True, True, False]
    """
    return "://" in text or text.partition(":")[0] in ENDPOINTS


def resolve_endpoint(text: str, *, model: str = "", key_name: str | None = None) -> Endpoint:
    """Return the endpoint for a server name or address.

    Args:
        text: A known name, NAME:MODEL, or an address http(s)://HOST/v1.
        model: The model, if the text does not name one.
        key_name: The environment variable with the API key. None uses the server's default.

    Raises:
        UnknownNameError: If the name is unknown.
        UsageError: If the address is invalid.

    Example:
        >>> names = ("qwen:qwen-vl-max", "http://localhost:8000/v1")
        >>> [resolve_endpoint(name).model for name in names]
        ['qwen-vl-max', '']
    """
    if "://" in text:
        found = Endpoint(_check_address(text))
    else:
        name, _, named = text.partition(":")
        if name not in ENDPOINTS:
            raise UnknownNameError("model server", name, ENDPOINTS)
        found = ENDPOINTS[name]
        found = replace(found, model=named or found.model)
    found = replace(found, model=model or found.model)
    return found if key_name is None else replace(found, key_name=key_name)


def _check_address(address: str) -> str:
    try:
        parts = urlsplit(address)
        fine = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
        secret = parts.username or parts.password
    except ValueError:
        fine, secret = False, None
    if secret:
        raise UsageError(
            "the address contains a password, which would be saved in records; name an "
            "environment variable (--key-env NAME) instead"
        )
    if not fine:
        raise UsageError(
            f"{address!r} is not a valid server address; expected one such as "
            "http://localhost:8000/v1"
        )
    return address.rstrip("/")


class BusyServerError(ServerError):
    """An error for a server that is busy, slow or unreachable, so that a retry may succeed."""

    def __init__(self, text: str, retry_after_s: float | None = None, *, may_cost: bool = False):
        super().__init__(text)
        self.retry_after_s, self.may_cost = retry_after_s, may_cost


class RefusedQuestionError(ServerError):
    """An error for a question that the server rejects, but may accept in another format."""


class UselessReplyError(ServerError):
    """An error for a reply that is too large or does not follow the protocol."""

    may_cost = True


class ChatTransport:
    """A connection to a chat server. It is thread-safe."""

    def __init__(
        self,
        endpoint: Endpoint,
        *,
        timeout_s: float,
        max_reply_bytes: int = MAX_REPLY_BYTES,
        clock: Callable[[], float] = time.monotonic,
    ):
        """Prepare a connection without sending anything.

        Args:
            endpoint: The server.
            timeout_s: Seconds to wait for one attempt.
            max_reply_bytes: The maximum size of a reply in bytes.
            clock: The function that returns the current time in seconds.

        Raises:
            MissingExtraError: If the SDK is not installed.
            UsageError: If the API key is not set.
        """
        try:
            import openai  # noqa: PLC0415  # An extra, and slow to import.
        except ImportError:
            raise MissingExtraError("querying a language model", "vln") from None
        self.endpoint, self.timeout_s = endpoint, timeout_s
        self._limit, self._clock, self._sdk = max_reply_bytes, clock, openai
        self._key = endpoint.key()
        http_client = openai.DefaultHttpxClient(
            event_hooks={"response": [self._refuse_failures]}, follow_redirects=False
        )
        self._client = openai.OpenAI(
            api_key=self._key,
            base_url=endpoint.url,
            timeout=timeout_s,
            max_retries=0,
            http_client=http_client,
            default_headers={"Accept-Encoding": "identity"},
        )

    def ask(self, question: Question) -> Reply:
        """Ask a question once.

        Raises:
            BusyServerError: If the server is busy, slow or unreachable.
            RefusedQuestionError: If the server rejects the question.
            UselessReplyError: If the reply is too large or invalid.
            ServerError: If the key or the address is wrong.
        """
        began = self._clock()
        with self._without_key():
            data = self._call(self._client.chat.completions, self._parameters(question))
            return _parse_reply(data, question, self._clock() - began)

    def models(self) -> tuple[str, ...]:
        """Return the names of the models on the server.

        Raises:
            ServerError: If the server does not return a valid list.
        """
        with self._without_key():
            data = self._call(self._client.models, None)
        listed = data.get("data") if isinstance(data, dict) else None
        entries = [one for one in _list(listed) if isinstance(one, dict)]
        return tuple(sanitize_text(str(one.get("id", ""))) for one in entries)

    def close(self) -> None:
        """Close the connection."""
        self._client.close()

    @contextmanager
    def _without_key(self) -> Iterator[None]:
        """Remove the API key from errors, because some servers return it and errors are saved."""
        try:
            yield
        except ServerError as error:
            if self._key != NO_KEY:
                error.args = (str(error).replace(self._key, "(the key)"),)
            raise

    def _parameters(self, question: Question) -> dict[str, Any]:
        parameters: dict[str, Any] = {
            "model": question.model,
            "messages": [turn.to_api() for turn in question.turns],
            self.endpoint.length_name: question.max_tokens,
        }
        if question.temperature is not None:
            parameters["temperature"] = question.temperature
        if question.form is not None:
            parameters["response_format"] = question.form
        return parameters

    def _call(self, part: Any, parameters: dict[str, Any] | None) -> Any:
        """Call a part of the SDK, and return the parsed JSON."""
        deadline = self._clock() + self.timeout_s
        streaming = part.with_streaming_response
        try:
            opened = streaming.list() if parameters is None else streaming.create(**parameters)
            with opened as response:
                data = self._read(response.iter_bytes(), response.headers, deadline)
        except ServerError:
            raise
        except self._sdk.APITimeoutError as error:
            raise self._timeout_error(_is_sent(error)) from None
        except self._sdk.APIConnectionError as error:
            if isinstance(error.__cause__, ServerError):  # Raised by _refuse_failures.
                raise error.__cause__ from None
            raise BusyServerError(
                f"{self.endpoint.url} cannot be reached: {_cause(error)}",
                may_cost=_is_sent(error),
            ) from None
        except Exception as error:  # Whatever the SDK and its transport raise on odd bytes.
            text = f"{self.endpoint.url} interrupted the connection: {_cause(error)}"
            raise BusyServerError(text, may_cost=True) from None
        try:
            return json.loads(data)
        except (ValueError, RecursionError):
            raise UselessReplyError(
                f"{self.endpoint.url} sent a reply that is not JSON: {_excerpt(data)}"
            ) from None

    def _read(self, pieces: Iterable[bytes], headers: Any, deadline: float) -> bytes:
        if headers.get("content-encoding", "identity") != "identity":
            raise UselessReplyError(
                f"{self.endpoint.url} sent a compressed reply although none was requested"
            )
        data = bytearray()
        for piece in pieces:
            data += piece
            if len(data) > self._limit:
                raise UselessReplyError(
                    f"{self.endpoint.url} sent a reply of more than {self._limit:,} bytes, "
                    "which exceeds the limit"
                )
            if self._clock() > deadline:
                raise self._timeout_error()
        return bytes(data)

    def _timeout_error(self, is_sent: bool = True) -> BusyServerError:
        return BusyServerError(
            f"{self.endpoint.url} did not reply within {self.timeout_s:g} s; raise --timeout",
            may_cost=is_sent,
        )

    def _refuse_failures(self, response: Any) -> None:
        """Raise the error for an HTTP status, reading only the first bytes of the body."""
        status = int(response.status_code)
        if 200 <= status < 300:
            return
        body = ""
        for piece in response.iter_raw():
            body = _excerpt(piece)
            break
        text = f"{self.endpoint.url} returned HTTP status {status}: {body or 'no message'}"
        if status in BUSY:
            raise BusyServerError(text, _seconds(response.headers.get("retry-after")))
        if status in REFUSED:
            raise RefusedQuestionError(text)
        if status in (401, 403):
            text += f"; check the API key in {self.endpoint.key_name or '--key-env NAME'}"
        raise ServerError(text)


def sanitize_text(text: str) -> str:
    """Remove control characters and lone surrogates from a text.

    Example:
        >>> sanitize_text("a" + chr(27) + "[31mb" + chr(0xd800))
        'a [31mb?'
    """
    whole = text.encode("utf-8", "replace").decode()
    return "".join(letter if letter.isprintable() or letter in "\n\t" else " " for letter in whole)


def _parse_reply(data: Any, question: Question, latency_s: float) -> Reply:
    choices = _list(data.get("choices")) if isinstance(data, dict) else []
    first = choices[0] if choices else None
    message = first.get("message") if isinstance(first, dict) else None
    if not isinstance(message, dict):
        raise UselessReplyError(
            f"the server sent a reply without a choice: {_excerpt(json.dumps(data).encode())}"
        )
    text = sanitize_text(_text(message.get("content")) or _text(message.get("refusal")))
    usage = data.get("usage")
    counts = [_count(usage, name) for name in ("prompt_tokens", "completion_tokens")]
    guessed = (estimate_tokens(question), len(text) // CHARACTERS_PER_TOKEN + 1)
    prompt, completion = (
        own if own is not None else guess for own, guess in zip(counts, guessed, strict=True)
    )
    if (total := _count(usage, "total_tokens")) is not None and None not in counts:
        completion = max(completion, total - prompt)  # Gemini leaves thoughts out of the others.
    finish = (
        sanitize_text(str(first.get("finish_reason") or ""))[:40] if isinstance(first, dict) else ""
    )
    return Reply(text, prompt, completion, finish, None in counts, round(latency_s, 3))


def _text(content: Any) -> str:
    """Return the text of a message content, which is a string or a list of parts."""
    if isinstance(content, str):
        return content
    texts = [part.get("text") for part in _list(content) if isinstance(part, dict)]
    return "".join(text for text in texts if isinstance(text, str))


def _count(usage: Any, name: str) -> int | None:
    value = usage.get(name) if isinstance(usage, dict) else None
    fine = type(value) is int and 0 <= value <= MAX_TOKENS_COUNTED
    return value if fine else None


def _list(value: Any) -> list[Any]:
    """Return a list unchanged, or an empty list for any other value."""
    return value if isinstance(value, list) else []


def _seconds(header: str | None) -> float | None:
    """Parse the seconds of a Retry-After header. Dates are ignored."""
    try:
        seconds = float(header or "")
    except ValueError:
        return None
    return seconds if 0 <= seconds < float("inf") else None


def _excerpt(data: bytes) -> str:
    """Return the beginning of a server's message."""
    words = sanitize_text(data[:4096].decode("utf-8", "replace")).split()
    return " ".join(words)[:MAX_EXCERPT]


def _is_sent(error: BaseException) -> bool:
    """Return whether a question may have reached the server before the connection failed."""
    return type(error.__cause__).__name__ not in UNSENT


def _cause(error: BaseException) -> str:
    inner = error.__cause__ or error
    return sanitize_text(str(inner) or type(inner).__name__)[:MAX_EXCERPT]
