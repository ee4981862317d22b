"""The ``/api/photos`` routes, which serve the photos of the camera strip.

==================================  ===========================================================
GET /api/photos                     ``{frames: [...], why}``: pose and field of view of each photo
GET /api/photos/N/small.jpg         the thumbnail of a photo
GET /api/photos/N/picture.jpg       the undistorted photo, as a pinhole camera would take it
GET /api/photos/N/classes.jpg       the same in the colours of its classes, which are predicted
==================================  ===========================================================
"""

import asyncio

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.sceneforge.run_photos import RunPhotos
from world2minecraft.sceneforge.server.error_messages import explain_error
from world2minecraft.sceneforge.server.request_parsing import get_workspace


def routes() -> list[BaseRoute]:
    """Return the routes of the camera strip."""
    return [
        Route("/api/photos", _all),
        Route("/api/photos/{number:int}/small.jpg", _small),
        Route("/api/photos/{number:int}/picture.jpg", _picture),
        Route("/api/photos/{number:int}/classes.jpg", _classes),
    ]


async def _all(request: Request) -> Response:
    """Return the photos, or the reason why there are none, which is not an error of the request."""
    try:
        found = await asyncio.to_thread(_photos, request)
    except World2MinecraftError as error:
        return JSONResponse({"frames": [], "why": explain_error(error)})
    return JSONResponse({"frames": found.as_json(), "why": ""})


async def _small(request: Request) -> Response:
    return await _jpeg(request, True)


async def _picture(request: Request) -> Response:
    return await _jpeg(request, False)


async def _classes(request: Request) -> Response:
    number = request.path_params["number"]
    workspace = get_workspace(request)
    data = await asyncio.to_thread(lambda: workspace.photo_classes().jpeg(number))
    return Response(data, media_type="image/jpeg")


async def _jpeg(request: Request, small: bool) -> Response:
    number = request.path_params["number"]
    data = await asyncio.to_thread(lambda: _photos(request).jpeg(number, small))
    return Response(data, media_type="image/jpeg")


def _photos(request: Request) -> RunPhotos:
    return get_workspace(request).photos()
