"""Agents: baselines that see nothing, experts that know the scene, and vision-language models."""

from world2minecraft.navigation.agents.registry import AGENTS, BESIDE, agent_of
from world2minecraft.navigation.agents.values import Agent, Decision, Guide, Sight, Task
from world2minecraft.navigation.agents.vlm_agent import ModelAgent

__all__ = [
    "AGENTS",
    "BESIDE",
    "Agent",
    "Decision",
    "Guide",
    "ModelAgent",
    "Sight",
    "Task",
    "agent_of",
]
