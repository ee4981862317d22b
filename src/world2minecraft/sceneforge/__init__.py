"""SceneForge: the web editor for scenes, its server and its Python interface."""
