"""The registry of agents by name: baselines, plug-ins and models behind a server."""

from collections.abc import Callable

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.registry import Registry
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import MAX_PX
from world2minecraft.external_models.chat_transport import ENDPOINTS, is_endpoint
from world2minecraft.navigation.agents.action_format import MAX_MOVES
from world2minecraft.navigation.agents.types import Agent
from world2minecraft.navigation.agents.vlm_agent import HISTORY, VlmAgent
from world2minecraft.navigation.agents.vlm_prompts import MAPS, MapKind

# Other packages add a class without parameters through the entry points world2minecraft.agent.
AGENTS = Registry(
    "agent",
    {
        "oracle": "world2minecraft.navigation.agents.baselines:OracleAgent",
        "shortest": "world2minecraft.navigation.agents.baselines:ShortestAgent",
        "random": "world2minecraft.navigation.agents.baselines:RandomAgent",
        "forward": "world2minecraft.navigation.agents.baselines:ForwardAgent",
        "stop": "world2minecraft.navigation.agents.baselines:StopAgent",
        "human": "world2minecraft.navigation.running.human_agent:HumanAgent",
    },
)
REFERENCE_AGENTS = ("stop", "random", "oracle")  # Reported with every result, for comparison.


def make_agent(
    text: str,
    chat: Callable[[], ChatModel],
    *,
    chunk: int = MAX_MOVES,
    history: int = HISTORY,
    map_kind: MapKind = "none",
    max_px: int = MAX_PX,
) -> Agent:
    """Return an agent by its name, or a ``VlmAgent`` if the name is a model endpoint.

    Args:
        text: The name of an agent, or an endpoint such as "gemini".
        chat: A function that opens the model of an endpoint.
        chunk: The maximum number of moves per reply of a model.
        history: The number of previous views to show to a model.
        map_kind: The map to show to a model: "none", "text" or "plan".
        max_px: The maximum number of pixels of an image for a model.

    Raises:
        UnknownNameError: If the agent, endpoint or map kind is unknown.
    """
    if map_kind not in MAPS:
        raise UnknownNameError("map", map_kind, MAPS)
    if is_endpoint(text):
        return VlmAgent(chat(), chunk=chunk, history=history, map_kind=map_kind, max_px=max_px)
    if text not in AGENTS.names():
        raise UnknownNameError("agent", text, [*AGENTS.names(), *ENDPOINTS])
    return AGENTS.load(text)()
