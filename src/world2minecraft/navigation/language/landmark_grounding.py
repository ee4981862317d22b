"""Checks whether a name identifies a single landmark for a human listener."""

from collections.abc import Sequence

from world2minecraft.navigation.landmarks import BESIDE_M, Landmark, gap_between_m


def unambiguous_landmarks(landmarks: Sequence[Landmark]) -> list[Landmark]:
    """Return the landmarks whose names match no other landmark.

    For example, "the table" is ambiguous if the scene also contains a coffee table.

    Args:
        landmarks: All landmarks of the scene.
    """
    return [
        one
        for one in landmarks
        if one.is_unambiguous and matching_landmarks(one.name, landmarks) == [one]
    ]


def matching_landmarks(phrase: str, landmarks: Sequence[Landmark]) -> list[Landmark]:
    """Return the landmarks that a phrase can refer to, by name, colour and the end of the noun.

    Args:
        phrase: The phrase without "the".
        landmarks: All landmarks of the scene.
    """
    phrase_words, _, anchor = phrase.partition(" beside the ")
    found = [
        one for one in landmarks if one.name == phrase or _matches_noun(phrase_words.split(), one)
    ]
    if not anchor:
        return found
    anchors = matching_landmarks(anchor, landmarks)
    return [
        one
        for one in found
        if any(one is not other and gap_between_m(one, other) <= BESIDE_M for other in anchors)
    ]


def _matches_noun(words: Sequence[str], landmark: Landmark) -> bool:
    noun = landmark.noun.split()
    for split in range(len(words)):
        phrase_words, colour = list(words[split:]), " ".join(words[:split])
        if noun[-len(phrase_words) :] == phrase_words and colour in ("", landmark.colour):
            return True
    return False
