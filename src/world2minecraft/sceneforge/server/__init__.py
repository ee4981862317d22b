"""The HTTP server of SceneForge: routes, websocket, guard and limits."""
