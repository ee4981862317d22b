"""Which letter the right answer has: by chance, and each as often as every other."""

import numpy as np

from world2minecraft.navigation.values import LETTERS


class LetterDeck:
    """Deals letters from shuffled packs of one each, so that no letter comes more often."""

    def __init__(self, rng: np.random.Generator, choices: int = 4):
        self._rng, self._letters = rng, LETTERS[:choices]
        self._pack: list[str] = []

    def deal(self) -> str:
        """Return the next letter."""
        if not self._pack:
            self._pack = [self._letters[n] for n in self._rng.permutation(len(self._letters))]
        return self._pack.pop()
