"""Clients of external models: Hugging Face networks, and language models on servers."""
