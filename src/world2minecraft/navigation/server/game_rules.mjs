// What mineflayer's physics lack of the game's, put around its tick.
//
// Three rules of prismarine-physics 1.11 differ from the game's. It moves a body along x before z,
// where the game takes the longer side first, which matters at corners. It keeps one who sneaks from
// edges by any block in the cells around, where the game asks what is within a step under the feet.
// And one who lands in the tick in which a wall stops him, and who steps along it, stays in the air.

const HALF = 0.3
const LOW = 1.5 // How high one is who sneaks.
const STEP = 0.6
const BACK = 0.05 // By so much one who sneaks draws back from an edge.
const TOUCH = 1e-7
const NOWHERE = [[0, -2000, 0, 1, -1999, 1]]

// Makes `physics.simulatePlayer` keep to the game; `Vec3` is the class of its places.
export function keepToTheGame (physics, Vec3) {
  const tick = physics.simulatePlayer
  physics.simulatePlayer = (state, world) => {
    const free = tick(copyOf(state), unobstructed(world))
    const way = free.pos.minus(state.pos)
    const kept = state.control.sneak && state.onGround && way.y <= 0 ? keptFromEdges(state, world, way) : way
    const from = state.pos.clone()
    const wasInAir = !state.onGround
    state.vel.x += kept.x - way.x
    state.vel.z += kept.z - way.z
    const turned = Math.abs(kept.x) < Math.abs(kept.z)
    if (turned) turn(state, Vec3)
    tick(state, turned ? turnedWorld(world, Vec3) : world)
    if (turned) turn(state, Vec3)
    for (const axis of ['x', 'z']) { // Drawing back from an edge costs no speed.
      const went = Math.abs(state.pos[axis] - from[axis] - kept[axis]) < TOUCH
      if (kept[axis] !== way[axis]) state.vel[axis] = went ? free.vel[axis] : 0
    }
    if (wasInAir && state.onGround && Math.abs(state.pos.y - from.y) < TOUCH && way.y < -TOUCH) {
      state.pos.y += freeFall(state, world, way.y)
    }
    return state
  }
}

function copyOf (state) {
  const copy = Object.assign(Object.create(Object.getPrototypeOf(state)), state)
  copy.pos = state.pos.clone()
  copy.vel = state.vel.clone()
  return copy
}

// The same blocks, of which none is in the way: what remains is where the keys alone would lead.
function unobstructed (world) {
  return { getBlock: place => changed(world.getBlock(place), { shapes: NOWHERE }) }
}

function changed (block, values) {
  if (!block) return block
  const copy = Object.create(block)
  for (const [name, value] of Object.entries(values)) Object.defineProperty(copy, name, { value })
  return copy
}

// The world with x and z changed for each other, so that what is x first in it is z first here.
function turnedWorld (world, Vec3) {
  return {
    getBlock: ({ x, y, z }) => {
      const block = world.getBlock(new Vec3(z, y, x))
      if (!block) return block
      const { position: p, shapes } = block
      return changed(block, {
        position: new Vec3(p.z, p.y, p.x),
        shapes: shapes.map(([x0, y0, z0, x1, y1, z1]) => [z0, y0, x0, z1, y1, x1])
      })
    }
  }
}

function turn (state, Vec3) {
  state.pos = new Vec3(state.pos.z, state.pos.y, state.pos.x)
  state.vel = new Vec3(state.vel.z, state.vel.y, state.vel.x)
  state.yaw = Math.PI / 2 - state.yaw
  state.control = { ...state.control, left: state.control.right, right: state.control.left }
}

function keptFromEdges ({ pos }, world, way) {
  const overNothing = (x, z) => {
    const box = [pos.x + x - HALF, pos.y - STEP, pos.z + z - HALF, pos.x + x + HALF, pos.y - STEP + LOW, pos.z + z + HALF]
    return !boxesNear(world, pos, box).some(other => overlap(box, other))
  }
  const nearer = value => Math.abs(value) <= BACK ? 0 : value - Math.sign(value) * BACK
  let { x, z } = way
  while (x && overNothing(x, 0)) x = nearer(x)
  while (z && overNothing(0, z)) z = nearer(z)
  while (x && z && overNothing(x, z)) [x, z] = [nearer(x), nearer(z)]
  return { x, y: way.y, z }
}

function freeFall ({ pos }, world, way) {
  const box = [pos.x - HALF, pos.y + way, pos.z - HALF, pos.x + HALF, pos.y, pos.z + HALF]
  const tops = boxesNear(world, pos, box).filter(other => overlap(box, other)).map(other => other[4])
  return Math.max(way, ...tops.map(top => top - pos.y))
}

function boxesNear (world, pos, box) {
  const found = []
  const cursor = pos.clone()
  for (cursor.y = Math.floor(box[1]) - 1; cursor.y <= Math.floor(box[4]); cursor.y++) {
    for (cursor.z = Math.floor(box[2]); cursor.z <= Math.floor(box[5]); cursor.z++) {
      for (cursor.x = Math.floor(box[0]); cursor.x <= Math.floor(box[3]); cursor.x++) {
        const block = world.getBlock(cursor)
        for (const s of block ? block.shapes : []) {
          const { x, y, z } = block.position
          found.push([s[0] + x, s[1] + y, s[2] + z, s[3] + x, s[4] + y, s[5] + z])
        }
      }
    }
  }
  return found
}

function overlap (one, two) {
  return [0, 1, 2].every(n => one[n] < two[n + 3] - TOUCH && one[n + 3] > two[n] + TOUCH)
}
