// One ray through the cells of a scene: render/ray.py in 32 bits.
//
// Coordinates are relative to `base`, a cell near the ray's origin, so that they stay exact
// wherever in a large world the camera stands. Cells are whole numbers of the grid.

const NO_FACE: i32 = 255;
const FAR: f32 = 1e30;
const SAME: f32 = 2e-6;  // Of the way: what lies so near to one surface counts as that surface.

struct Ray {
  base: vec3<i32>,
  o: vec3<f32>,
  d: vec3<f32>,
  r: vec3<f32>,  // 1 / d
}

// `element` is -1 for a full cube; `face` is the element's own, NO_FACE for nothing.
struct Hit {
  t: f32,
  cell: vec3<i32>,
  face: i32,
  element: i32,
}

fn nothing() -> Hit {
  return Hit(0.0, vec3<i32>(-1), NO_FACE, -1);
}

fn number(at: u32) -> f32 {
  return bitcast<f32>(tables[at]);
}

fn numbers(at: u32) -> vec3<f32> {
  return vec3<f32>(number(at), number(at + 1u), number(at + 2u));
}

fn grid() -> vec3<i32> {
  return vec3<i32>(P.size_x, P.size_y, P.size_z);
}

fn inside(cell: vec3<i32>) -> bool {
  return all(cell >= vec3<i32>(0)) && all(cell < grid());
}

fn cell_value(cell: vec3<i32>) -> i32 {
  return cells[(cell.x * P.size_y + cell.y) * P.size_z + cell.z];
}

fn steep(d: vec3<f32>) -> vec3<f32> {
  return select(d, vec3<f32>(1e-12), abs(d) <= vec3<f32>(1e-12));
}

// The point of a box that is seen from a side: a face's normal is against the ray.
fn entry_face(axis: i32, r: vec3<f32>) -> i32 {
  return 2 * axis + select(1, 0, r[axis] > 0.0);
}

fn axis_of_greatest(v: vec3<f32>) -> i32 {
  if (v.x >= v.y && v.x >= v.z) {
    return 0;
  }
  return select(2, 1, v.y >= v.z);
}

fn axis_of_least(v: vec3<f32>) -> i32 {
  if (v.x <= v.y && v.x <= v.z) {
    return 0;
  }
  return select(2, 1, v.y <= v.z);
}

fn cell_at(ray: Ray, t: f32) -> vec3<i32> {
  return ray.base + vec3<i32>(floor(ray.o + t * ray.d));
}

// The first cell of a ray; its face is NO_FACE where it begins there, its cell -1 for a miss.
fn begin(ray: Ray) -> Hit {
  let first = cell_at(ray, 0.0);
  if (inside(first)) {
    return Hit(0.0, first, NO_FACE, -1);
  }
  let a = (vec3<f32>(-ray.base) - ray.o) * ray.r;
  let b = (vec3<f32>(grid() - ray.base) - ray.o) * ray.r;
  let enter = min(a, b);
  let leave = max(a, b);
  let axis = axis_of_greatest(enter);
  let t = enter[axis];
  if (t <= 0.0 || t >= min(leave.x, min(leave.y, leave.z))) {
    return nothing();
  }
  let cell = clamp(cell_at(ray, t), vec3<i32>(0), grid() - 1);
  return Hit(t, cell, entry_face(axis, ray.r), -1);
}

// The cell behind an empty box. Cells go on along the ray, whatever rounding says: it ends.
fn cross_box(ray: Ray, at: Hit, box: u32) -> Hit {
  let word = P.at_bounds + 3u * box;
  let a = tables[word];
  let b = tables[word + 1u];
  let c = tables[word + 2u];
  let low = vec3<i32>(vec3<u32>(a & 0xffffu, a >> 16u, b & 0xffffu));
  let high = vec3<i32>(vec3<u32>(b >> 16u, c & 0xffffu, c >> 16u));
  let forward = ray.d > vec3<f32>(0.0);
  let planes = select(low, high, forward);
  let ts = (vec3<f32>(planes - ray.base) - ray.o) * ray.r;
  let axis = axis_of_least(ts);
  let t = ts[axis];
  var cell = clamp(cell_at(ray, t), low, high - 1);
  cell = select(min(cell, at.cell), max(cell, at.cell), forward);
  cell[axis] = select(low[axis] - 1, high[axis], forward[axis]);
  return Hit(t, cell, entry_face(axis, ray.r), -1);
}

fn leave_cell(ray: Ray, cell: vec3<i32>) -> Hit {
  let forward = ray.d > vec3<f32>(0.0);
  let planes = select(cell, cell + 1, forward);
  let ts = (vec3<f32>(planes - ray.base) - ray.o) * ray.r;
  let axis = axis_of_least(ts);
  var next = cell;
  next[axis] += select(-1, 1, forward[axis]);
  return Hit(ts[axis], next, entry_face(axis, ray.r), -1);
}

// The first surface from a cell on, after `after`.
fn first_hit(ray: Ray, start: Hit, after: f32) -> Hit {
  var at = start;
  for (var step = 0u; step < P.most_steps; step++) {
    if (!inside(at.cell)) {
      break;
    }
    let value = cell_value(at.cell);
    if (value >= 0) {
      at = cross_box(ray, at, u32(value));
      continue;
    }
    let code = -1 - value;
    let next = leave_cell(ray, at.cell);
    if ((code & 1) == 0) {
      if (at.face != NO_FACE && at.t > 0.0 && at.t >= after * (1.0 - SAME)) {
        return Hit(at.t, at.cell, at.face, -1);
      }
    } else {
      let met = meet_cell(ray, at.cell, u32(code >> 1u), after, next.t);
      if (met.face != NO_FACE) {
        return met;
      }
    }
    at = next;
  }
  return nothing();
}
