"""Clients of external models: networks from a model hub, and language models on servers."""
