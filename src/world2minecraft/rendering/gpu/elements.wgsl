// The elements of one cell: aligned and turned boxes, holes, glass and its joins.

const ABSOLUTE: u32 = 1u;
const SEE_THROUGH: u32 = 2u;
const UNSHADED: u32 = 4u;
const JOINS: u32 = 8u;
const EVEN: u32 = 16u;
const PANE: u32 = 32u;
const SOLID: u32 = 250u;  // Alpha of a texel of glass from which on nothing is seen behind.
const TRANSLUCENT: i32 = 0x40000000;  // Of a layer's word.

fn element_word(n: i32) -> u32 {
  return P.at_elements + u32(n) * ELEMENT_WORDS;
}

fn flags_of(n: i32) -> u32 {
  return tables[element_word(n) + FLAGS_WORD];
}

fn turn_of(n: i32) -> i32 {
  return bitcast<i32>(tables[element_word(n) + TURN_WORD]);
}

fn owner_of(n: i32) -> i32 {
  return bitcast<i32>(tables[element_word(n) + OWNER_WORD]);
}

fn face_word(n: i32, face: i32) -> u32 {
  return element_word(n) + FACES_WORD + u32(face) * FACE_WORDS;
}

// -1 for no face, else the texture, and whether it is translucent.
fn layer_of(n: i32, face: i32) -> i32 {
  return bitcast<i32>(tables[face_word(n, face)]);
}

// Whether one sees through a hit: it is glass, and its texture is not solid there.
fn is_clear(ray: Ray, hit: Hit) -> bool {
  let n = hit.element;
  if (hit.face == NO_FACE || n < 0) {
    return false;
  }
  let layer = layer_of(n, hit.face);
  if (layer < 0 || ((layer & TRANSLUCENT) == 0 && (flags_of(n) & PANE) == 0u)) {
    return false;
  }
  let turn = turn_of(n);
  let own = own_place(hit, n, turn, place_of(ray, hit, n, turn));
  return (texel_of(layer, texture_place(n, hit.face, own), 0u, P.side_px) >> 24u) < SOLID;
}

// A place of a hit's cell in the frame of its element.
fn own_place(hit: Hit, n: i32, turn: i32, place: vec3<f32>) -> vec3<f32> {
  let own = place + vec3<f32>(hit.cell - anchor_of(n, hit.cell));
  if (turn >= 0) {
    return turned(turn, own, 1.0);
  }
  return own;
}

// The cell that an element's coordinates count from.
fn anchor_of(n: i32, cell: vec3<i32>) -> vec3<i32> {
  let word = element_word(n);
  if ((tables[word + FLAGS_WORD] & ABSOLUTE) == 0u) {
    return cell;
  }
  let at = word + ANCHOR_WORD;
  return bitcast<vec3<i32>>(vec3<u32>(tables[at], tables[at + 1u], tables[at + 2u]));
}

// Carry a point (w = 1) or a direction (w = 0) into the frame of a turned element.
fn turned(turn: i32, v: vec3<f32>, w: f32) -> vec3<f32> {
  let at = P.at_turns + u32(turn) * TURN_WORDS;
  return vec3<f32>(
    dot(numbers(at), v) + number(at + 3u) * w,
    dot(numbers(at + 4u), v) + number(at + 7u) * w,
    dot(numbers(at + 8u), v) + number(at + 11u) * w,
  );
}

// u and v of a point of an element's own frame.
fn texture_place(n: i32, face: i32, p: vec3<f32>) -> vec2<f32> {
  let at = face_word(n, face) + UV_WORD;
  return vec2<f32>(
    dot(numbers(at), p) + number(at + 3u),
    dot(numbers(at + 4u), p) + number(at + 7u),
  );
}

fn texel_of(layer: i32, place: vec2<f32>, start: u32, side: i32) -> u32 {
  let share = place - floor(place);
  let at = clamp(vec2<i32>(share * f32(side)), vec2<i32>(0), vec2<i32>(side - 1));
  let row = u32(layer & ~TRANSLUCENT) * P.texel_count + start;
  return texels[row + u32(at.y * side + at.x)];
}

fn joined(cell: vec3<i32>, face: i32) -> bool {
  var other = cell;
  other[face / 2] += select(-1, 1, (face & 1) == 1);
  return inside(other) && cell_value(other) == cell_value(cell);
}

// What a ray meets first among the elements of a cell, after `after`; of standing boxes only what
// lies before `until`, where it leaves the cell. Of two at one place the later one counts.
fn meet_cell(ray: Ray, cell: vec3<i32>, look: u32, after: f32, until: f32) -> Hit {
  var best = Hit(FAR, cell, NO_FACE, -1);
  let last = tables[P.at_starts + look + 1u];
  for (var place = tables[P.at_starts + look]; place < last; place++) {
    let n = bitcast<i32>(tables[P.at_refs + place]);
    let flags = flags_of(n);
    let turn = turn_of(n);
    var p = ray.o + vec3<f32>(ray.base - anchor_of(n, cell));
    var e = ray.d;
    var r = ray.r;
    if (turn >= 0) {
      p = turned(turn, p, 1.0);
      e = steep(turned(turn, ray.d, 0.0));
      r = 1.0 / e;
    }
    let word = element_word(n);
    let a = (numbers(word) - p) * r;
    let b = (numbers(word + 3u) - p) * r;
    let enter = min(a, b);
    let leave = max(a, b);
    let axis = axis_of_greatest(enter);
    let t = enter[axis];
    if (t > min(leave.x, min(leave.y, leave.z)) || t <= 0.0 || t > best.t) {
      continue;
    }
    if (after > 0.0 && t <= after * (1.0 + SAME)) {
      continue;
    }
    if ((flags & ABSOLUTE) != 0u && t > until * (1.0 + SAME) + SAME) {
      continue;
    }
    let face = entry_face(axis, r);
    if ((flags & SEE_THROUGH) != 0u) {
      let layer = layer_of(n, face);
      if (layer < 0 || ((flags & JOINS) != 0u && joined(cell, face))) {
        continue;
      }
      if ((layer & TRANSLUCENT) == 0 && (flags & PANE) == 0u) {
        let at = texture_place(n, face, p + t * e);
        if ((texel_of(layer, at, 0u, P.side_px) >> 24u) < 128u) {
          continue;
        }
      }
    }
    best = Hit(t, cell, face, n);
  }
  return best;
}
