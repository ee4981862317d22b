"""SceneForge: the web editor of a scene, its server and the Python that drives it."""
