"""The path tracing kernel, which follows paths from the eye through a scene to light sources.

At each surface the sun and one emitter are sampled. The path then continues with one of the
surface's lobes. The sky is only found by such paths; emitters are found in both ways, combined by
multiple importance sampling. Glass transmits and tints light, or reflects it if it is the first
surface.
"""

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.light.sky import background_light
from world2minecraft.rendering.path_tracing.film import add_sample, luminance, store_center_surface
from world2minecraft.rendering.path_tracing.light_sampling import (
    emitter_row,
    sample_emitter,
    sampling_density,
)
from world2minecraft.rendering.path_tracing.rng import hash_uint32, sample_pair
from world2minecraft.rendering.path_tracing.scattering import (
    GLOSS,
    MATT,
    SHARP_WIDTH,
    UNDECIDED,
    copy_vector,
    evaluate_gloss,
    glass_texel,
    is_glass,
    load_surface,
    lobe_width,
    pane_reflectance,
    sample_gloss,
    sample_matt,
    set_lobes,
)
from world2minecraft.rendering.path_tracing.sky_light import sample_sun, sky_radiance
from world2minecraft.rendering.ray_caster.ray import (
    SOLID,
    Hit,
    first_cell,
    first_hit,
    make_ray,
    ray_of_pixel,
)
from world2minecraft.rendering.scene_tables import ABSOLUTE, FLAGS, NO_FACE, TURN

MAX_PANES = 12  # Of glass that one path passes.
MAX_INDIRECT = 2.0  # What a path may bring that was not aimed, or by several bounces: it is cut.
SEEN_GLOW = 2.2  # How bright a lamp itself is seen, beside its texture; what it gives is another.
SHADE_GLOW = 0.8  # The same of a lampshade, a panel of a lamp's neighbour that lies on it.
SEEN_WARM_G, SEEN_WARM_B = 0.84, 0.58  # The colour of both, beside red, half and half with theirs.
_SHADE = 0.25  # Cells: the thickest lampshade.
_OFF = 1e-4  # Cells: how far before a surface a new ray begins.
_WIDE = 0.35  # How a beam widens that a matt surface sends on.
_MIRROR_ODDS = 0.2  # How often at least the mirror of the first pane is followed.


@lean
def trace_rows(scene, emitters, sky, camera, rows, samples, seed, depth, state, film):
    """Add samples to the rows of a film. The first call also finds the centre surfaces.

    Args:
        scene: ``PathScene``.
        emitters: ``Emitters``.
        sky: ``SkyLight``.
        camera: A pinhole ``GridCamera``.
        rows: First row and end row.
        samples: First sample and end sample.
        seed: Random seed, uint32.
        depth: Maximum number of surfaces on a path.
        state: Scratch memory of this band, from ``new_path()``.
        film: ``Film``.
    """
    s = state[0]
    width = film.far.shape[1]
    for v in range(rows[0], rows[1]):
        for u in range(width):
            s.key = hash_uint32(np.uint32(v * width + u) ^ hash_uint32(np.uint32(seed)))
            # One more than the samples asks for the middle, which is found first.
            for sample in range(samples[0] - (1 if samples[0] == 0 else 0), samples[1]):
                begin_path(camera, u, v, sample, s)
                follow_path(scene, emitters, sky, 0 if sample < 0 else depth, s)
                if sample >= 0:
                    add_sample(film, v, u, s)
                elif s.own == 1:
                    store_center_surface(film, v, u, s)


@inlined
def begin_path(camera, u, v, sample, s):
    """Start a path at a position within a pixel. Sample -1 is the pixel's centre."""
    pose, rays = camera.pose, camera.rays
    s.sample, s.use = sample, 1
    across, down = 0.5, 0.5
    if sample >= 0:
        across, down = sample_pair(s.key, sample, 0)
    x, y = (u + across - rays[2]) / rays[0], (v + down - rays[3]) / rays[1]
    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, 1.0)
    length = np.sqrt(dx * dx + dy * dy + dz * dz)
    s.o[0], s.o[1], s.o[2] = ox, oy, oz
    s.d[0], s.d[1], s.d[2] = dx / length, dy / length, dz / length
    s.wide, s.widens = 0.0, 0.7 / (rays[0] * np.sqrt(x * x + y * y + 1.0))
    s.lobe, s.sharp, s.bounces, s.own = UNDECIDED, 1, 0, 0
    for n in range(3):
        s.share[n] = 1.0
        s.seen[n], s.spread[n], s.gloss[n] = 0.0, 0.0, 0.0
        s.spread_share[n], s.gloss_share[n] = 0.0, 0.0


@inlined
def follow_path(scene, emitters, sky, depth, s):
    """Follow a path to its end."""
    tables, side_px = scene.tables, scene.side_px
    ray = make_ray(s.o[0], s.o[1], s.o[2], s.d[0], s.d[1], s.d[2])
    hit = first_cell(tables.space.shape, ray)
    after = 0.0
    for _ in range(depth + MAX_PANES):
        if hit.i >= 0:
            hit = first_hit(tables, side_px, ray, hit, after)
        if hit.i < 0 or hit.face == NO_FACE:
            add_sky_radiance(sky, s)
            return
        s.t, s.face, s.element = hit.t, hit.face, hit.element
        s.cell[0], s.cell[1], s.cell[2] = hit.i, hit.j, hit.k
        load_surface(scene, s)
        if s.clear and not reflects_on_glass(s, depth):
            after = hit.t
            hit = Hit(hit.t, hit.i, hit.j, hit.k, NO_FACE, hit.element)
            continue
        if not s.clear:
            first = s.lobe == UNDECIDED
            if first:
                copy_vector(s.first, s.at)
                copy_vector(s.first_out, s.out)
                s.own = 1
            if depth == 0:
                return
            add_emitter_radiance(tables, emitters, s)
            if s.bounces == depth:
                return
            set_lobes(s)
            if first:
                for n in range(3):
                    s.spread_share[n] += s.share[n] * s.matt[n]
                    s.gloss_share[n] += s.share[n] * s.shine[n]
            add_direct_light(scene, emitters, sky, s)
            if not sample_bounce(s):
                return
        for n in range(3):
            s.o[n] = s.at[n] + _OFF * s.out[n]
        ray = make_ray(s.o[0], s.o[1], s.o[2], s.d[0], s.d[1], s.d[2])
        hit = first_cell(tables.space.shape, ray)
        after = 0.0


@inlined
def add_radiance(s, r, g, b, rare):
    """Add radiance to a path, in the part given by its first surface, and clamp outliers."""
    if s.lobe == UNDECIDED:
        s.seen[0] += r
        s.seen[1] += g
        s.seen[2] += b
        return
    if rare:
        bright = luminance(r, g, b)
        if bright > MAX_INDIRECT:
            r, g, b = (
                r * MAX_INDIRECT / bright,
                g * MAX_INDIRECT / bright,
                b * MAX_INDIRECT / bright,
            )
    if s.lobe == MATT:
        s.spread[0] += r
        s.spread[1] += g
        s.spread[2] += b
    else:
        s.gloss[0] += r
        s.gloss[1] += g
        s.gloss[2] += b


@inlined
def add_sky_radiance(sky, s):
    """Add the radiance of the visible sky (eye and mirror rays) or of the lighting sky."""
    if s.sharp:
        r, g, b = background_light(s.d[0], s.d[1], s.d[2], sky.background)
    else:
        r, g, b = sky_radiance(s.d[0], s.d[1], s.d[2], sky)
    add_radiance(s, s.share[0] * r, s.share[1] * g, s.share[2] * b, s.bounces > 1)


@inlined
def add_emitter_radiance(tables, emitters, s):
    """Add the radiance of a lamp that the path has hit."""
    if s.sharp:
        glow = SEEN_GLOW * s.level
        if glow <= 0 and is_lampshade(tables, emitters, s):
            glow = SHADE_GLOW
        if glow > 0:
            glow, peak = 0.5 * glow, max(s.colour[0], s.colour[1], s.colour[2])
            r = glow * (s.colour[0] + peak)
            g = glow * (s.colour[1] + peak * SEEN_WARM_G)
            b = glow * (s.colour[2] + peak * SEEN_WARM_B)
            add_radiance(s, s.share[0] * r, s.share[1] * g, s.share[2] * b, s.bounces > 1)
        return
    row = emitter_row(emitters, tables.space.shape, s, s.element)
    if row >= 0:
        part = s.last / (s.last + sampling_density(emitters, row, s))
        r, g, b = emitters.light[row, 0], emitters.light[row, 1], emitters.light[row, 2]
        add_radiance(s, part * s.share[0] * r, part * s.share[1] * g, part * s.share[2] * b, True)


@inlined
def is_lampshade(tables, emitters, s):
    """Return whether the surface is that of a thin panel on a lamp of the next cell."""
    n, axis = s.element, s.face // 2
    if tables.traits[n, FLAGS] & ABSOLUTE or tables.traits[n, TURN] >= 0:
        return False
    if tables.boxes[n, axis + 3] - tables.boxes[n, axis] > _SHADE:
        return False
    i = int(np.floor(s.at[0] - _SHADE * s.out[0]))
    j = int(np.floor(s.at[1] - _SHADE * s.out[1]))
    k = int(np.floor(s.at[2] - _SHADE * s.out[2]))
    if i == s.cell[0] and j == s.cell[1] and k == s.cell[2]:
        return False
    x, y, z = tables.space.shape
    if i < 0 or j < 0 or k < 0 or i >= x or j >= y or k >= z:
        return False
    return emitters.row_of_cell[i, j, k] >= 0


@inlined
def reflects_on_glass(s, depth):
    """Pass through a pane, or return True to follow its reflection; sets the share and the ray."""
    mirror = pane_reflectance(s)
    odds = 0.0
    if s.lobe == UNDECIDED and depth > 0:
        for n in range(3):
            s.gloss_share[n] += s.share[n] * mirror
        odds = min(max(mirror, _MIRROR_ODDS), 0.5)
        number, _ = sample_pair(s.key, s.sample, s.use)
        s.use += 1
        if number < odds:
            s.lobe, s.bounces = GLOSS, s.bounces + 1
            into = 2.0 * (s.out[0] * s.d[0] + s.out[1] * s.d[1] + s.out[2] * s.d[2])
            for n in range(3):
                s.share[n] *= mirror / odds
                s.d[n] -= into * s.out[n]
            return True
        for n in range(3):
            s.share[n] *= (1.0 - mirror) / (1.0 - odds)
    for n in range(3):
        s.share[n] *= 1.0 - s.alpha + s.alpha * s.colour[n]
    return False


@inlined
def add_direct_light(scene, emitters, sky, s):
    """Sample the sun and one lamp, and add the light that reaches the surface."""
    s.weights, s.aim_odds, only = 0.0, 1.0, -1
    has_sun, has_lamps = sky.sun_r + sky.sun_g + sky.sun_b > 0, len(emitters.cell) > 0
    pick, other = sample_pair(s.key, s.sample, s.use + 1)
    if s.bounces > 0 and has_sun and has_lamps:  # One of both is enough for what is sent on.
        s.aim_odds, only = 0.5, 0 if other < 0.5 else 1
    for which in range(2):
        if which == 0:
            if not has_sun or only == 1:
                continue
            first, second = sample_pair(s.key, s.sample, s.use)
            s.to[0], s.to[1], s.to[2] = sample_sun(sky, first, second)
            s.far, s.density, s.unseen = np.inf, 1.0, 1
            s.aimed[0], s.aimed[1] = np.pi * sky.sun_r, np.pi * sky.sun_g
            s.aimed[2] = np.pi * sky.sun_b
        else:
            first, second = sample_pair(s.key, s.sample, s.use + 2)
            if not has_lamps or not sample_emitter(emitters, s, pick, first, second) or only == 0:
                continue
            s.density *= s.aim_odds
        above = s.out[0] * s.to[0] + s.out[1] * s.to[1] + s.out[2] * s.to[2]
        cosine = s.normal[0] * s.to[0] + s.normal[1] * s.to[1] + s.normal[2] * s.to[2]
        if above <= 0 or cosine <= 0 or not is_unoccluded(scene, s):
            continue
        matt = (1.0 - s.gloss_odds) * cosine / np.pi
        part = 1.0 if s.unseen else s.density / (s.density + matt)
        gloss, gloss_part, lobe = 0.0, 0.0, s.lobe
        if s.gloss_odds > 0 and lobe_width(s) >= SHARP_WIDTH:
            gloss, density = evaluate_gloss(s, s.to[0], s.to[1], s.to[2])
            density *= s.gloss_odds
            gloss_part = 1.0 if s.unseen else s.density / (s.density + density)
        part *= cosine / (np.pi * s.aim_odds)
        gloss *= gloss_part / s.aim_odds
        s.bounces += 1
        for kind in range(2):
            if kind == 1 and gloss <= 0:
                break
            s.lobe = (MATT if kind == 0 else GLOSS) if lobe == UNDECIDED else lobe
            for n in range(3):
                s.to[n] = s.share[n] * s.aimed[n] * s.way[n]
                s.to[n] *= part * s.matt[n] if kind == 0 else gloss * s.shine[n]
            add_radiance(s, s.to[0], s.to[1], s.to[2], s.bounces > 1)
        s.lobe = lobe
        s.bounces -= 1
    s.use += 3


@inlined
def is_unoccluded(scene, s):
    """Return whether only glass is between a point and a light; ``way`` receives the glass tint."""
    tables, side_px, decode = scene.tables, scene.side_px, scene.decode
    ray = make_ray(
        s.at[0] + _OFF * s.out[0], s.at[1] + _OFF * s.out[1], s.at[2] + _OFF * s.out[2],
        s.to[0], s.to[1], s.to[2],
    )  # fmt: skip
    s.way[0], s.way[1], s.way[2] = 1.0, 1.0, 1.0
    until = s.far - 3 * _OFF
    hit = first_cell(tables.space.shape, ray)
    after = 0.0
    for _ in range(MAX_PANES):
        if hit.i < 0:
            return True
        hit = first_hit(tables, side_px, ray, hit, after)
        t, i, j, k, face, n = hit
        if face == NO_FACE or t >= until:
            return True
        if n < 0 or not is_glass(tables, n, face):
            return False
        x, y, z = ray.ox + t * ray.dx, ray.oy + t * ray.dy, ray.oz + t * ray.dz
        at = glass_texel(tables, side_px, n, face, i, j, k, x, y, z)
        texel = tables.texels[tables.layers[n, face], at]
        if texel[3] >= SOLID:
            return False
        alpha = texel[3] / 255.0
        for c in range(3):
            s.way[c] *= 1.0 - alpha + alpha * decode[texel[c]] * tables.tints[n, face, c]
        after = t
        hit = Hit(t, i, j, k, NO_FACE, n)
    return False


@inlined
def sample_bounce(s):
    """Choose a lobe and a direction, and return whether the path continues."""
    pick, stay = sample_pair(s.key, s.sample, s.use)
    first, second = sample_pair(s.key, s.sample, s.use + 1)
    s.use += 2
    s.wide += s.widens * s.t
    if pick < s.gloss_odds:
        width = lobe_width(s)
        share, density = sample_gloss(s, first, second)
        if density <= 0:  # The mirror sends it into the surface.
            return False
        s.last = density * s.gloss_odds
        s.sharp = 1 if width < SHARP_WIDTH else 0
        s.widens += 0.5 * width
        for n in range(3):
            s.share[n] *= share * s.shine[n] / s.gloss_odds
        if s.lobe == UNDECIDED:
            s.lobe = GLOSS
    else:
        s.last = sample_matt(s, first, second) * (1.0 - s.gloss_odds)
        s.sharp, s.widens = 0, _WIDE
        for n in range(3):
            s.share[n] *= s.matt[n] / (1.0 - s.gloss_odds)
        if s.lobe == UNDECIDED:
            s.lobe = MATT
    s.bounces += 1
    copy_vector(s.from_at, s.at)
    copy_vector(s.from_out, s.out)
    if s.d[0] * s.out[0] + s.d[1] * s.out[1] + s.d[2] * s.out[2] <= 0:
        return False
    if s.bounces > 1:  # Weak paths end at random, and the others count for them.
        lasts = min(max(s.share[0], s.share[1], s.share[2]), 0.95)
        if stay >= lasts:
            return False
        for n in range(3):
            s.share[n] /= lasts
    return True
