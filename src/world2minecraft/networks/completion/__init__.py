"""The completion network: virtual scans for training, the network, its training and its export.

Samples are created without PyTorch. ``docs/how-to/train-completion.md`` describes the commands.
"""
