"""Random numbers by hashing, which depend only on the pixel, the sample and their use.

The first uses of a path come from a two-dimensional Sobol sequence, whose order and values are
scrambled by hashes of the pixel (Owen scrambling), so that 16 samples are evenly distributed. Later
uses, which would not benefit, are plain hashes.
"""

import numpy as np

from world2minecraft.core.jit import inlined

EVEN_USES = 12  # Pairs of numbers that are spread evenly over the samples of a pixel.
_U = np.uint32
_SHARE = 1.0 / 4294967296.0


@inlined
def hash_uint32(x):
    """Return a hash of a uint32."""
    x = _U(x)
    x = _U(x ^ _U(x >> _U(16)))
    x = _U(x * _U(0x7FEB352D))
    x = _U(x ^ _U(x >> _U(15)))
    x = _U(x * _U(0x846CA68B))
    return _U(x ^ _U(x >> _U(16)))


@inlined
def reverse_bits(x):
    """Return a uint32 with its bits in reverse order."""
    x = _U(_U(x >> _U(16)) | _U(x << _U(16)))
    x = _U(_U((x & _U(0x00FF00FF)) << _U(8)) | _U((x & _U(0xFF00FF00)) >> _U(8)))
    x = _U(_U((x & _U(0x0F0F0F0F)) << _U(4)) | _U((x & _U(0xF0F0F0F0)) >> _U(4)))
    x = _U(_U((x & _U(0x33333333)) << _U(2)) | _U((x & _U(0xCCCCCCCC)) >> _U(2)))
    return _U(_U((x & _U(0x55555555)) << _U(1)) | _U((x & _U(0xAAAAAAAA)) >> _U(1)))


@inlined
def owen_scramble(x, seed):
    """Return the Owen-scrambled value of a uint32 whose bits are given in reverse order."""
    x = _U(x ^ _U(x * _U(0x3D20ADEA)))
    x = _U(x + seed)
    x = _U(x * _U(_U(seed >> _U(16)) | _U(1)))
    x = _U(x ^ _U(x * _U(0x05526C56)))
    x = _U(x ^ _U(x * _U(0x53A22864)))
    return reverse_bits(x)


@inlined
def sobol_second_dimension(x):
    """Return the second Sobol coordinate of an index, with its bits in reverse order.

    It is computed as a bit matrix, Pascal's triangle modulo 2, applied by halves.
    """
    x = _U(x ^ _U(x >> _U(16)))
    x = _U(x ^ _U(_U(x & _U(0xFF00FF00)) >> _U(8)))
    x = _U(x ^ _U(_U(x & _U(0xF0F0F0F0)) >> _U(4)))
    x = _U(x ^ _U(_U(x & _U(0xCCCCCCCC)) >> _U(2)))
    return _U(x ^ _U(_U(x & _U(0xAAAAAAAA)) >> _U(1)))


@inlined
def sample_pair(pixel_key, sample, use):
    """Return two random numbers in [0, 1) for a given use of a sample.

    Args:
        pixel_key: Hash of the pixel and the seed, uint32.
        sample: Index of the sample in the pixel.
        use: Index of the purpose of the numbers, from 0. Different uses get independent numbers.
    """
    key = hash_uint32(_U(pixel_key) ^ hash_uint32(_U(use) + _U(0x9E3779B9)))
    if use >= EVEN_USES:
        first = hash_uint32(key ^ hash_uint32(_U(sample) + _U(0x85EBCA6B)))
        return first * _SHARE, hash_uint32(first + key) * _SHARE
    # A nested shuffle of the order lets pairs of different uses know nothing of each other.
    place = owen_scramble(reverse_bits(_U(sample)), key)
    x = owen_scramble(place, hash_uint32(key + _U(1)))
    y = owen_scramble(sobol_second_dimension(place), hash_uint32(key + _U(2)))
    return x * _SHARE, y * _SHARE
