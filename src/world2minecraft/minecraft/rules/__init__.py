"""The game's rules for blocks: connections, support and light."""
