"""Reading and writing of Bedrock structures, and conversion to and from Java block states."""
