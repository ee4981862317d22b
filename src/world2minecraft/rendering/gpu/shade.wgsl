// The colour of a point: render/shade.py and render/light in 32 bits. All colours are linear.

const MOST_GLASS: i32 = 32;  // Panes that one ray goes through.
const NEAR_EDGE: f32 = 1e-3;
const OFF: f32 = 1e-4;  // Blocks: how far before a surface a ray to the sun begins.
const MOST_TEXELS: f32 = 2.25;  // For a pixel, before the next mip level takes over.
const SCREEN_MOST: f32 = 2.0;

fn normal_of(turn: i32, face: i32) -> vec3<f32> {
  let sign = select(-1.0, 1.0, (face & 1) == 1);
  if (turn < 0) {
    var normal = vec3<f32>(0.0);
    normal[face / 2] = sign;
    return normal;
  }
  return sign * numbers(P.at_turns + u32(turn) * TURN_WORDS + 12u + 3u * u32(face / 2));
}

// The face of a block that looks most like a face of an element.
fn main_face(turn: i32, face: i32) -> i32 {
  if (turn < 0) {
    return face;
  }
  let word = tables[P.at_turns + u32(turn) * TURN_WORDS + 21u];
  return i32((word >> (4u * u32(face))) & 15u);
}

fn to_linear(screen: vec3<f32>) -> vec3<f32> {
  let value = min(screen, vec3<f32>(SCREEN_MOST));
  let square = value * value;
  let high = (0.61682 - value * 0.14103) * square;
  return square * (0.55340 + value * 1.02762 - square * 1.05753 + high * value);
}

// The light that an entry of the lattice stands for: a table, made by the CPU's own functions.
fn corner_light(index: u32, even: bool) -> vec3<f32> {
  let word = (light[index >> 1u] >> (16u * (index & 1u))) & select(0x3fffu, 0x0fffu, even);
  let at = AT_CORNERS + 3u * word;
  return bitcast<vec3<f32>>(vec3<u32>(tone[at], tone[at + 1u], tone[at + 2u]));
}

// The light at a place p of a cell, on a face of the block: even between the face's four corners.
fn face_light(cell: vec3<i32>, face: i32, p: vec3<f32>, even: bool) -> vec3<f32> {
  let axis = face / 2;
  var step = 0;  // A face inside its cell is lit by the cell's own layer.
  if ((face & 1) == 1 && p[axis] > 1.0 - NEAR_EDGE) {
    step = 1;
  } else if ((face & 1) == 0 && p[axis] < NEAR_EDGE) {
    step = -1;
  }
  let first = select(0, 1, axis == 0);
  let second = select(2, 1, axis == 2);
  let size = grid() + 2;
  var at = cell;
  at[axis] += step + 1;
  var aside = vec3<i32>(0);
  aside[first] = 1;
  var along = vec3<i32>(0);
  along[second] = 1;
  let row = vec3<i32>(size.y * size.z, size.z, 1);
  let scale = vec3<u32>(row);
  let start = u32(axis) * u32(size.x) * scale.x + dot(vec3<u32>(at), scale);
  let a = dot(vec3<u32>(aside), scale);
  let b = dot(vec3<u32>(along), scale);
  let share = clamp(vec2<f32>(p[first], p[second]), vec2<f32>(0.0), vec2<f32>(1.0));
  let low = mix(corner_light(start, even), corner_light(start + b, even), share.y);
  let high = mix(corner_light(start + a, even), corner_light(start + a + b, even), share.y);
  return mix(low, high, share.x);
}

fn direction_shade(normal: vec3<f32>, cosine: f32) -> f32 {
  let upright = select(P.lit_shade_down, P.lit_shade_up, normal.y > 0.0);
  let square = normal * normal;
  let shade = dot(vec3<f32>(P.lit_shade_x, upright, P.lit_shade_z), square);
  let whole = shade * (1.0 - P.lit_headlight * (1.0 - cosine));
  if (P.lit_screen > 0.0) {
    return to_linear(vec3<f32>(whole)).x;
  }
  return whole;
}

fn decoded(texel: u32) -> vec3<f32> {
  return bitcast<vec3<f32>>(vec3<u32>(
    tone[texel & 255u], tone[(texel >> 8u) & 255u], tone[(texel >> 16u) & 255u],
  ));
}

// Linear colour and alpha of a texture; `block_px` is how many pixels a block covers there.
fn texel_colour(n: i32, face: i32, p: vec3<f32>, block_px: f32, cosine: f32) -> vec4<f32> {
  var side = P.side_px;
  var start = 0u;
  let along = f32(side) / (block_px * max(cosine, 0.04));
  var many = along * along;
  while (many > MOST_TEXELS && side > 1) {
    start += u32(side * side);
    side /= 2;
    many *= 0.25;
  }
  let texel = texel_of(layer_of(n, face), texture_place(n, face, p), start, side);
  let tint = numbers(face_word(n, face) + TINT_WORD);
  return vec4<f32>(decoded(texel) * tint, f32(texel >> 24u) / 255.0);
}

// Whether nothing but glass lies between a place of a cell and the sun.
fn sun_reaches(cell: vec3<i32>, p: vec3<f32>) -> bool {
  let d = steep(vec3<f32>(P.lit_sun_x, P.lit_sun_y, P.lit_sun_z));
  let ray = Ray(cell, p, d, 1.0 / d);
  var at = begin(ray);
  for (var pane = 0; pane < MOST_GLASS; pane++) {
    if (at.cell.x < 0) {
      return true;
    }
    at = first_hit(ray, at, at.t);
    if (at.face == NO_FACE) {
      return true;
    }
    if (!is_clear(ray, at)) {
      return false;
    }
    at.face = NO_FACE;
  }
  return false;
}

// Where a hit lies in its cell; on the plane of its face exactly, so that no light leaks.
fn place_of(ray: Ray, hit: Hit, n: i32, turn: i32) -> vec3<f32> {
  var p = (ray.o + vec3<f32>(ray.base - hit.cell)) + hit.t * ray.d;
  let axis = hit.face / 2;
  if (hit.element < 0) {
    p[axis] = f32(hit.face & 1);
  } else if (turn < 0) {
    let side = element_word(n) + u32(axis + 3 * (hit.face & 1));
    p[axis] = number(side) + f32(anchor_of(n, hit.cell)[axis] - hit.cell[axis]);
  }
  return p;
}

// Linear colour and alpha of a hit; `metre_px` is how many pixels a length of the ray's direction
// covers, seen straight on, at t = 1.
fn shade_hit(ray: Ray, hit: Hit, metre_px: f32) -> vec4<f32> {
  var n = hit.element;
  if (n < 0) {
    let look = u32((-1 - cell_value(hit.cell)) >> 1u);
    n = bitcast<i32>(tables[P.at_refs + tables[P.at_starts + look]]);
  }
  let flags = flags_of(n);
  let turn = turn_of(n);
  let p = place_of(ray, hit, n, turn);
  let own = own_place(hit, n, turn, p);
  let normal = normal_of(turn, hit.face);
  let face = main_face(turn, hit.face);
  let speed = length(ray.d);
  let cosine = abs(dot(normal, ray.d)) / speed;
  let block_px = metre_px / (speed * select(1.0, hit.t, P.spread > 0.0));
  let texel = texel_colour(n, hit.face, own, block_px, cosine);
  let shade = select(direction_shade(normal, cosine), 1.0, (flags & UNSHADED) != 0u);
  var lit = shade * face_light(hit.cell, face, p, (flags & EVEN) != 0u);
  if (P.lit_sun_r > 0.0) {
    let sun = dot(normal, vec3<f32>(P.lit_sun_x, P.lit_sun_y, P.lit_sun_z));
    let off = select(OFF, OFF + 4e-7 * hit.t * speed, turn >= 0);
    if (sun > 0.0 && sun_reaches(hit.cell, p + off * normal)) {
      lit += sun * vec3<f32>(P.lit_sun_r, P.lit_sun_g, P.lit_sun_b);
    }
  }
  let emission = number(element_word(n) + EMISSION_WORD);
  if (emission > 0.0) {
    let glow = vec3<f32>(emission * P.lit_glow);
    lit = max(lit, select(glow, to_linear(glow), P.lit_screen > 0.0));
  }
  return vec4<f32>(texel.rgb * lit, texel.a);
}
