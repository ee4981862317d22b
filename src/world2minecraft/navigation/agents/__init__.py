"""Agents: blind baselines, privileged experts that know the scene, and vision-language models."""

from world2minecraft.navigation.agents.registry import AGENTS, REFERENCE_AGENTS, make_agent
from world2minecraft.navigation.agents.types import Agent, Decision, Guide, Observation, Task
from world2minecraft.navigation.agents.vlm_agent import VlmAgent

__all__ = [
    "AGENTS",
    "REFERENCE_AGENTS",
    "Agent",
    "Decision",
    "Guide",
    "Observation",
    "Task",
    "VlmAgent",
    "make_agent",
]
