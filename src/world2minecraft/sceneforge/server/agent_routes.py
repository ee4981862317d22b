"""The routes by which a model walks through the room.

============================  ================================================================
``GET /api/agents``           the models that may walk
``POST /api/agents/walk``     begin a walk: ``agent``, ``to``, ``feet_m``, ``look_m``
``POST /api/agents/step``     the next decision of a walk: ``walk``, its number
============================  ================================================================
"""

import asyncio
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.sceneforge.agent_walks import WalkingModels
from world2minecraft.sceneforge.build_preview import BuildOptions
from world2minecraft.sceneforge.server.build_preview_routes import builds_of, check_sentence
from world2minecraft.sceneforge.server.request_parsing import (
    parse_point,
    parse_scale,
    read_json_object,
)


def routes() -> list[BaseRoute]:
    """Return the routes. They walk by ``state.models`` of the application."""
    return [
        Route("/api/agents", _agents),
        Route("/api/agents/walk", _begin, methods=["POST"]),
        Route("/api/agents/step", _step, methods=["POST"]),
    ]


class AgentTurns:
    """The models of a server, which decide one after another.

    Args:
        models: The models.
    """

    def __init__(self, models: WalkingModels):
        self.models = models
        self._turn = asyncio.Lock()

    async def begin(self, request: Request, fields: dict[str, Any]) -> int:
        """Begin a walk and return its number.

        Raises:
            UsageError: If a field is invalid.
            InputError: If there is no floor to stand on.
        """
        agent, sentence = str(fields.get("agent", "")), check_sentence(fields.get("to", ""))
        feet_m, look_m = (
            parse_point(name, fields.get(name), "[1.5, 2, 0]") for name in ("feet_m", "look_m")
        )
        scale = parse_scale(fields.get("blocks_per_metre", 4), int | float)
        guide = await builds_of(request).guide(BuildOptions(scale))
        async with self._turn:
            return await asyncio.to_thread(
                self.models.begin, guide, agent, sentence, feet_m, look_m
            )

    async def step(self, fields: dict[str, Any]) -> dict[str, Any]:
        """Return the next decision of a walk.

        Raises:
            UsageError: If the walk has ended.
            BudgetError: If the cost limit is reached.
            ServerError: If the model cannot be asked.
        """
        async with self._turn:
            return await asyncio.to_thread(self.models.decide, fields.get("walk", 0))


async def _agents(request: Request) -> Response:
    return JSONResponse({"agents": _turns(request).models.agents.names})


async def _begin(request: Request) -> Response:
    return JSONResponse(
        {"walk": await _turns(request).begin(request, await read_json_object(request))}
    )


async def _step(request: Request) -> Response:
    return JSONResponse(await _turns(request).step(await read_json_object(request)))


def _turns(request: Request) -> AgentTurns:
    return request.app.state.agent_turns
