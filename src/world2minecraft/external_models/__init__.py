"""Models of others, asked for by name: networks from a hub, and language models on servers."""
