"""Rendering of several shots: opened rooms, turntables and streams of frames."""
