// One invocation a pixel: what its ray meets, and the colour of it.

const HALO: f32 = 0.35;
const DISC_COSINE: f32 = 0.9990;
const DISC: f32 = 4.0;
const PALING: f32 = 0.18;
const ENCODE_LAST: f32 = 4095.0;

struct View {
  x: vec4<f32>,  // Rows of camera to grid; the last column is relative to `base`.
  y: vec4<f32>,
  z: vec4<f32>,
  base: vec3<i32>,
  first_row: i32,
  ahead: f32,  // How far from the camera its rays begin.
}

struct Seen {
  first: Hit,
  behind: Hit,
  length: f32,
  colour: vec3<f32>,
}

fn ray_through(view: View, at: vec2<f32>) -> Ray {
  let near = vec3<f32>(at * (1.0 - P.spread), 0.0);
  let far = vec3<f32>(at * P.spread, 1.0);
  let o = vec3<f32>(dot(view.x.xyz, near), dot(view.y.xyz, near), dot(view.z.xyz, near));
  let d = steep(vec3<f32>(dot(view.x.xyz, far), dot(view.y.xyz, far), dot(view.z.xyz, far)));
  return Ray(view.base, o + vec3<f32>(view.x.w, view.y.w, view.z.w), d, 1.0 / d);
}

fn sky(d: vec3<f32>) -> vec3<f32> {
  let horizon = vec3<f32>(P.sky_horizon_r, P.sky_horizon_g, P.sky_horizon_b);
  var colour = vec3<f32>(0.0);
  if (d.y >= 0.0) {
    let low = 1.0 - d.y;
    colour = mix(vec3<f32>(P.sky_zenith_r, P.sky_zenith_g, P.sky_zenith_b), horizon, low * low * low);
  } else {
    let low = (1.0 + d.y) * (1.0 + d.y) * (1.0 + d.y);
    colour = mix(vec3<f32>(P.sky_ground_r, P.sky_ground_g, P.sky_ground_b), horizon, low * low);
  }
  let cosine = dot(d, vec3<f32>(P.sky_sun_x, P.sky_sun_y, P.sky_sun_z));
  if (cosine > 0.0 && d.y > -0.05) {
    let square = cosine * cosine;
    let fourth = square * square;
    let halo = select(fourth * fourth * fourth * fourth * HALO, DISC, cosine > DISC_COSINE);
    colour += halo * vec3<f32>(P.sky_sun_r, P.sky_sun_g, P.sky_sun_b);
  }
  return colour;
}

fn backdrop(d: vec3<f32>, down: f32) -> vec3<f32> {
  if (P.by_row == 0u) {
    return sky(d / length(d));
  }
  let first = vec3<f32>(P.paper_first_r, P.paper_first_g, P.paper_first_b);
  let last = vec3<f32>(P.paper_last_r, P.paper_last_g, P.paper_last_b);
  return mix(first, last, down);
}

// Values of the screen, 0 to 255, of linear light.
fn finish(light: vec3<f32>) -> vec3<u32> {
  var colour = light;
  let peak = max(light.r, max(light.g, light.b));
  if (peak > P.shoulder) {
    let room = 1.0 - P.shoulder;
    let pressed = 1.0 - room * room / (peak - P.shoulder + room);
    let keep = 1.0 / (1.0 + PALING * (peak - pressed));
    colour = light * (keep * pressed / peak) + pressed * (1.0 - keep);
  }
  colour = select(vec3<f32>(0.0), min(colour, vec3<f32>(1.0)), colour > vec3<f32>(0.0));
  let at = vec3<u32>(colour * ENCODE_LAST + 0.5);
  return vec3<u32>(encoded(at.x), encoded(at.y), encoded(at.z));
}

fn encoded(at: u32) -> u32 {
  return (tone[AT_ENCODE + (at >> 2u)] >> (8u * (at & 3u))) & 255u;
}

// What a ray sees. `at` is where it goes through the plane z = 1; `scale` is pixels of the ray's
// grid for each of the picture; `down` is 0 in the first row and 1 in the last.
fn look(view: View, at: vec2<f32>, scale: f32, down: f32, first_too: bool, coloured: bool) -> Seen {
  let ray = ray_through(view, at);
  var seen = Seen(nothing(), nothing(), sqrt(dot(at, at) * P.spread + 1.0), vec3<f32>(0.0));
  let metre_px = P.fx * scale * seen.length;
  var hit = begin(ray);
  var after = 0.0;
  var clear = 1.0;
  for (var pane = 0; pane <= MOST_GLASS; pane++) {
    hit = first_hit(ray, hit, after);
    if (pane == 0) {
      seen.first = hit;
      if (!coloured && !(first_too && P.plane_opaque >= 0)) {
        return seen;
      }
    }
    if (hit.face == NO_FACE || pane == MOST_GLASS) {
      break;
    }
    let glass = is_clear(ray, hit);
    if (coloured) {
      let shaded = shade_hit(ray, hit, metre_px);
      let share = select(clear, clear * shaded.a, glass);
      seen.colour += share * shaded.rgb;
      clear -= share;
    }
    if (!glass) {
      break;
    }
    after = hit.t;
    hit.face = NO_FACE;
  }
  seen.behind = hit;
  if (coloured && hit.face == NO_FACE) {
    seen.colour += clear * backdrop(ray.d, down);
  }
  return seen;
}

// The volume's cell (-1 for none) and the standing thing (-1 for none) of a hit.
fn owners(hit: Hit) -> vec2<i32> {
  if (hit.face == NO_FACE) {
    return vec2<i32>(-1);
  }
  var owner = -1;
  if (hit.element >= 0) {
    owner = owner_of(hit.element);
  }
  if (owner >= 0) {
    return vec2<i32>(-1, owner);
  }
  if (owner < -1) {
    return vec2<i32>(-2 - owner, -1);
  }
  let cell = hit.cell - vec3<i32>(P.first_x, P.first_y, P.first_z);
  return vec2<i32>((cell.x * P.window_y + cell.y) * P.window_z + cell.z, -1);
}

fn write(plane: i32, at: u32, value: u32) {
  out[at + u32(plane) * P.plane_words] = value;
}

fn write_behind(hit: Hit, ahead: f32, at: u32) {
  let owner = owners(hit);
  write(P.plane_opaque, at, bitcast<u32>(select(hit.t + ahead, 0.0, hit.face == NO_FACE)));
  write(P.plane_opaque + 1, at, bitcast<u32>(owner.x));
  write(P.plane_opaque + 2, at, bitcast<u32>(owner.y));
}

fn write_first(seen: Seen, ahead: f32, at: u32, colour: vec3<u32>) {
  let hit = seen.first;
  let none = hit.face == NO_FACE;
  let owner = owners(hit);
  var turn = -1;
  if (hit.element >= 0) {
    turn = turn_of(hit.element);
  }
  var face = NO_FACE;
  var normal = vec3<f32>(0.0);
  if (!none) {
    face = main_face(turn, hit.face);
    normal = normal_of(turn, hit.face);
  }
  write(0, at, bitcast<u32>(select(hit.t + ahead, 0.0, none)));
  write(1, at, bitcast<u32>(select((hit.t + ahead) * seen.length, 0.0, none)));
  write(2, at, bitcast<u32>(owner.x));
  write(3, at, colour.r | (colour.g << 8u) | (colour.b << 16u) | (u32(face) << 24u));
  if (P.plane_label >= 0) {
    var label = 0u;
    if (owner.x >= 0) {
      label = labels[owner.x];
    } else if (owner.y >= 0) {
      label = labels[P.at_things + u32(owner.y)];
    }
    write(P.plane_label, at, label);
  }
  if (P.plane_thing >= 0) {
    write(P.plane_thing, at, bitcast<u32>(owner.y));
  }
  if (P.plane_normal >= 0) {
    write(P.plane_normal, at, bitcast<u32>(normal.x));
    write(P.plane_normal + 1, at, bitcast<u32>(normal.y));
    write(P.plane_normal + 2, at, bitcast<u32>(normal.z));
  }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
  let view = views[id.z];
  let row = u32(view.first_row) + id.y;
  if (id.x >= P.width || id.y >= P.band_rows || row >= P.height) {
    return;
  }
  let focal = vec2<f32>(P.fx, P.fy);
  let middle = vec2<f32>(P.cx, P.cy);
  let at = (id.z * P.planes) * P.plane_words + id.y * P.width + id.x;
  let many = P.samples * P.samples;
  let fine = P.wants_colour != 0u && P.samples > 1u;
  var sum = vec3<u32>(0u);
  var first: Seen;
  for (var n = 0u; n <= select(0u, many, fine); n++) {
    var scale = 1.0;
    var pixel = vec2<u32>(id.x, row);
    if (n > 0u) {
      scale = f32(P.samples);
      pixel = pixel * P.samples + vec2<u32>((n - 1u) % P.samples, (n - 1u) / P.samples);
    }
    let place = (vec2<f32>(pixel) + 0.5 - middle * scale) / (focal * scale);
    let down = f32(pixel.y) / max(f32(P.height) * scale - 1.0, 1.0);
    let coloured = P.wants_colour != 0u && (n > 0u || !fine);
    let seen = look(view, place, scale, down, n == 0u, coloured);
    if (n == 0u) {
      first = seen;
    }
    if (coloured) {
      sum += finish(seen.colour);
    }
  }
  let colour = select(sum, (sum + many / 2u) / many, fine);
  write_first(first, view.ahead, at, colour);
  if (P.plane_opaque >= 0) {
    write_behind(first.behind, view.ahead, at);
  }
}
