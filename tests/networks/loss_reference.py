"""Each loss once more in numpy, cell by cell, from its definition."""

import math

import numpy as np


def softmax(logits):
    """[12, ...] to shares."""
    powers = np.exp(logits - logits.max(axis=0))
    return powers / powers.sum(axis=0)


def cross_entropy(logits, labels, weights):
    total = weight = 0.0
    for b in range(len(labels)):
        for cell in np.ndindex(labels.shape[1:]):
            name = int(labels[(b, *cell)])
            if name == 255:
                continue
            share = softmax(logits[(b, slice(None), *cell)])[name]
            total += -weights[name] * math.log(share)
            weight += weights[name]
    return total / weight if weight else 0.0


def affinity(shares, truth):
    """-log precision, -log recall, -log specificity of one class, over lists of cells."""
    met = sum(p * t for p, t in zip(shares, truth, strict=True))
    missed = sum((1 - p) * (1 - t) for p, t in zip(shares, truth, strict=True))
    found = 0.0
    if sum(truth):
        found += -math.log(met / sum(shares)) - math.log(met / sum(truth))
    if len(truth) - sum(truth):
        found += -math.log(missed / (len(truth) - sum(truth)))
    return found


def known_cells(logits, labels):
    cells = [
        (softmax(logits[(b, slice(None), *cell)]), int(labels[(b, *cell)]))
        for b in range(len(labels))
        for cell in np.ndindex(labels.shape[1:])
    ]
    return [(shares, name) for shares, name in cells if name != 255]


def semantic(logits, labels):
    cells = known_cells(logits, labels)
    present = sorted({name for _, name in cells})
    each = [
        affinity([shares[k] for shares, _ in cells], [float(name == k) for _, name in cells])
        for k in present
    ]
    return sum(each) / len(each) if each else 0.0


def geometric(logits, labels):
    cells = known_cells(logits, labels)
    return affinity([1 - s[0] for s, _ in cells], [float(name != 0) for _, name in cells])


def frusta(logits, labels, inputs, size=8):
    """By the centre of each cell: its camera's axes, its pixel, its part of the picture."""
    height, width = inputs.image.shape[-2:]
    said, truth = np.zeros((size * size, 12)), np.zeros((size * size, 12))
    for b in range(len(labels)):
        lens = inputs.intrinsics[b].double().numpy()
        to_camera = np.linalg.inv(inputs.camera_to_grid[b].double().numpy())
        for cell in np.ndindex(labels.shape[1:]):
            name = int(labels[(b, *cell)])
            place = (np.array(cell) + 0.5) * inputs.voxel_m
            x, y, z = (to_camera @ [*place, 1])[:3]
            if z <= 1e-3 or name == 255:
                continue
            u, v = lens[0, 0] * x / z + lens[0, 2], lens[1, 1] * y / z + lens[1, 2]
            if not (0 <= u < width and 0 <= v < height):
                continue
            part = int(v // (height / size)) * size + int(u // (width / size))
            said[part] += softmax(logits[(b, slice(None), *cell)])
            truth[part, name] += 1
    parts = [k for k in range(size * size) if truth[k].sum()]
    total = 0.0
    for k in parts:
        share, told = truth[k] / truth[k].sum(), said[k] / truth[k].sum()
        total += sum(share[n] * math.log(share[n] / told[n]) for n in range(12) if share[n] > 0)
    return total / len(parts) if parts else 0.0


def coarse(labels, factor=4):
    """SSCNet's rule for one grid [X, Y, Z]; cells beyond the grid are unknown."""
    shape = tuple(-(-side // factor) for side in labels.shape)
    found = np.zeros(shape, int)
    for cell in np.ndindex(shape):
        block = np.full((factor,) * 3, 255)
        part = labels[tuple(slice(c * factor, (c + 1) * factor) for c in cell)]
        block[tuple(slice(0, side) for side in part.shape)] = part
        empty, unknown = (block == 0).sum(), (block == 255).sum()
        if empty + unknown > 0.95 * factor**3:
            found[cell] = 0 if empty > unknown else 255
        else:
            counts = np.bincount(block[(block != 0) & (block != 255)], minlength=12)
            found[cell] = counts.argmax()
    return found


def relations(labels):
    """Which relations hold for one coarse grid, [4, M, N], and which pairs are known, [M, N]."""
    cells = labels.reshape(-1)
    megas = [
        [labels[2 * x + i, 2 * y + j, 2 * z + k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
        for x, y, z in np.ndindex(*(side // 2 for side in labels.shape))
    ]
    held = np.zeros((4, len(megas), len(cells)), bool)
    known = np.zeros((len(megas), len(cells)), bool)
    for m, eight in enumerate(megas):
        for n, cell in enumerate(cells):
            for other in eight:
                if cell == 255 or other == 255:
                    continue
                known[m, n] = True
                if cell and other:
                    held[0 if cell == other else 1, m, n] = True
                else:
                    held[2 if cell == other else 3, m, n] = True
    return held, known


def relation_loss(logits, labels):
    found = [relations(coarse(one)) for one in labels]
    total = count = 0.0
    for relation in range(4):
        pairs = [
            (float(logits[b, relation, m, n]), bool(held[relation, m, n]))
            for b, (held, known) in enumerate(found)
            for m, n in np.argwhere(known)
        ]
        yes = sum(truth for _, truth in pairs)
        balance = (len(pairs) - yes) / yes if yes else 1.0
        for value, truth in pairs:
            share = 1 / (1 + math.exp(-value))
            total += -balance * math.log(share) if truth else -math.log(1 - share)
            count += 1
    return total / count if count else 0.0


def depth(logits, depth_m, far=10.0):
    """Bins of growing width, each pixel of the branch covering a block of whole pixels."""
    bins, h, w = logits.shape[1:]
    edges = [far * k * (k + 1) / (bins * (bins + 1)) for k in range(bins + 1)]
    total = count = 0.0
    for b, row, column in np.ndindex(len(logits), h, w):
        high, wide = depth_m.shape[1] // h, depth_m.shape[2] // w
        block = depth_m[
            b, row * high : (row + 1) * high, column * wide : (column + 1) * wide
        ].reshape(-1)
        block = [value for value in block if value > 0]
        if not block or min(block) >= far:
            continue
        name = max(k for k in range(bins) if edges[k] <= min(block))
        total += -math.log(softmax(logits[b, :, row, column])[name])
        count += 1
    return total / count if count else 0.0
