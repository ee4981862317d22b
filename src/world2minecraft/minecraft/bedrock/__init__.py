"""Structures of the Bedrock Edition, and the table between its states and Java's."""
