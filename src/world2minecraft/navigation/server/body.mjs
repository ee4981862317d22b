// A player on a running server that does what lines of JSON on stdin say, and answers on stdout.
//
// node body.mjs FOLDER: the folder whose node_modules hold mineflayer. Each line has an id and a
// `do`; each answer has that id and either `error`, one sentence, or what was asked for. Time
// stands still for the player between two `hold`: it does not move, while the server goes on.

import { createRequire } from 'node:module'
import path from 'node:path'
import { deflateSync } from 'node:zlib'
import { keepToTheGame } from './game_rules.mjs'

const require = createRequire(path.join(path.resolve(process.argv[2]), 'package.json'))
const say = process.stdout.write.bind(process.stdout)
console.log = console.info = console.warn = console.error // stdout is for answers alone.

const KEYS = ['forward', 'back', 'left', 'right', 'jump', 'sneak', 'sprint'] // Bits, from the least.
const MOST_LINE = 1 << 20
const MOST_TICKS = 400
const MOST_CHANGES = 4096 // Then whoever asks reads all blocks again.
const SETTLE_MS = 3000
const NEAR = 0.01 // Blocks.

let bot = null
let gone = null // Why the player is no longer there.
let running = null // The ticks that are being held.
let forced = 0 // How often the server put the player somewhere.
let changed = new Map()
let tooMany = false
const texts = new Map()

const wait = milliseconds => new Promise(resolve => setTimeout(resolve, milliseconds))

function stateText (stateId) {
  let text = texts.get(stateId)
  if (text === undefined) {
    const Block = require('prismarine-block')(bot.registry)
    const block = Block.fromStateId(stateId, 0)
    const properties = block.getProperties()
    const pairs = Object.keys(properties).sort().map(name => `${name}=${properties[name]}`)
    text = `minecraft:${block.name}` + (pairs.length ? `[${pairs.join(',')}]` : '')
    texts.set(stateId, text)
  }
  return text
}

function pose () {
  const { position: p, velocity: v, onGround, isCollidedHorizontally } = bot.entity
  return [p.x, p.y, p.z, v.x, v.y, v.z, onGround ? 1 : 0, isCollidedHorizontally ? 1 : 0]
}

function news () {
  const cells = [...changed.values()]
  const answer = { pose: pose(), forced, changed: cells, too_many: tooMany }
  forced = 0
  changed = new Map()
  tooMany = false
  return answer
}

function need () {
  if (!bot) throw new Error('no player has joined')
  if (gone) throw new Error(gone)
}

function leave (reason) {
  if (gone) return
  gone = reason
  if (running) finish(new Error(reason))
}

// The game's client lets nobody sprint who sneaks or does not go ahead; mineflayer would.
function press ([bits, yaw, pitch]) {
  const held = Object.fromEntries(KEYS.map((key, bit) => [key, Boolean(bits >> bit & 1)]))
  held.sprint &&= held.forward && !held.back && !held.sneak
  for (const key of KEYS) bot.setControlState(key, held[key])
  const { fromNotchianYaw, fromNotchianPitch } = require('mineflayer/lib/conversions')
  bot.entity.yaw = fromNotchianYaw(yaw)
  bot.entity.pitch = fromNotchianPitch(pitch)
}

function finish (error) {
  const { resolve, reject, timer } = running
  running = null
  clearTimeout(timer)
  if (bot) bot.physicsEnabled = false
  error ? reject(error) : resolve()
}

function onTick () {
  if (!running) return
  running.poses.push(pose())
  if (running.poses.length === running.ticks.length) return finish()
  press(running.ticks[running.poses.length])
}

async function hold ({ ticks }) {
  need()
  if (running) throw new Error('keys are held already')
  if (!Array.isArray(ticks) || ticks.length < 1 || ticks.length > MOST_TICKS ||
      !ticks.every(tick => Array.isArray(tick) && tick.length === 3 && tick.every(Number.isFinite))) {
    throw new Error(`ticks are 1 to ${MOST_TICKS} of [keys, yaw, pitch]`)
  }
  const poses = []
  await new Promise((resolve, reject) => {
    const timer = setTimeout(() => {
      finish(new Error('the server has not sent the ground under the player'))
    }, SETTLE_MS + ticks.length * 200)
    running = { ticks, poses, resolve, reject, timer }
    press(ticks[0])
    bot.physicsEnabled = true
  })
  return { poses, ...news() }
}

async function join ({ host, port, name, version, wait_ms: limit }) {
  if (bot) throw new Error('a player has joined already')
  const mineflayer = require('mineflayer')
  bot = mineflayer.createBot({
    host, port, username: name, version: version || false, auth: 'offline', hideErrors: true,
    physicsEnabled: false, respawn: true, checkTimeoutInterval: 60000, viewDistance: 'far'
  })
  const reasonText = reason => (typeof reason === 'string' ? reason : JSON.stringify(reason)).slice(0, 500)
  bot.on('kicked', reason => leave(`the server sent the player away: ${reasonText(reason)}`))
  bot.on('error', error => leave(`no connection (${error.message || error.code || error}); is the server running there?`))
  bot.on('end', reason => leave(`the connection ended: ${reasonText(reason ?? 'closed')}`))
  bot.on('death', () => { forced++ })
  bot.on('forcedMove', () => { forced++ })
  bot.on('physicsTick', onTick)
  bot.on('blockUpdate', (old, block) => {
    if (!block) return
    const { x, y, z } = block.position
    if (changed.size >= MOST_CHANGES) tooMany = true
    else changed.set(`${x},${y},${z}`, [x, y, z, stateText(block.stateId)])
  })
  await Promise.race([
    new Promise(resolve => bot.once('spawn', resolve)),
    untilGone(),
    wait(limit).then(() => { throw new Error(`the server let nobody in within ${limit / 1000} s`) })
  ])
  if (!process.env.W2M_PLAIN_MINEFLAYER) keepToTheGame(bot.physics, require('vec3').Vec3)
  forced = 0
  return { version: bot.version, name: bot.username, mode: bot.game.gameMode, ...news() }
}

async function untilGone () {
  while (!gone) await wait(50)
  throw new Error(gone)
}

// Says a command and waits until the server has put the player there.
async function place ({ x, y, z, wait_ms: limit }) {
  need()
  const away = () => Math.hypot(x - bot.entity.position.x, y - bot.entity.position.y, z - bot.entity.position.z)
  if (away() > 1e-6) bot.chat(`/tp ${bot.username} ${x.toFixed(6)} ${y.toFixed(6)} ${z.toFixed(6)}`)
  for (let waited = 0; waited < limit && away() > NEAR; waited += 50) {
    need()
    await wait(50)
  }
  bot.entity.velocity.set(0, 0, 0)
  return { moved: away() <= NEAR, ...news() }
}

// All of the blocks from low to high, both included, of one chunk column.
async function blocks ({ low, high, wait_ms: limit }) {
  need()
  const { Vec3 } = require('vec3')
  const [x0, y0, z0] = low
  const [x1, y1, z1] = high
  if (x0 >> 4 !== x1 >> 4 || z0 >> 4 !== z1 >> 4) throw new Error('blocks are of one chunk')
  let column = null
  for (let waited = 0; !column && waited <= limit; waited += 100) {
    need()
    column = bot.world.getColumnAt(new Vec3(x0, y0, z0))
    if (!column) await wait(100)
  }
  if (!column) return { missing: true }
  const names = new Map()
  const found = new Uint16Array((x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1))
  const least = bot.game.minY ?? 0
  const most = least + (bot.game.height ?? 256)
  let n = 0
  for (let x = x0; x <= x1; x++) {
    for (let y = y0; y <= y1; y++) {
      for (let z = z0; z <= z1; z++) {
        const there = y >= least && y < most ? column.getBlockStateId(new Vec3(x & 15, y, z & 15)) : 0
        if (!names.has(there)) names.set(there, names.size)
        found[n++] = names.get(there)
      }
    }
  }
  const bytes = Buffer.from(found.buffer, found.byteOffset, found.byteLength)
  return { palette: [...names.keys()].map(stateText), states: deflateSync(bytes).toString('base64') }
}

async function leaveServer () {
  const there = bot
  leave('the player has left')
  if (there) there.quit()
  setTimeout(() => process.exit(0), 200)
  return {}
}

const ACTS = { join, hold, place, blocks, where: async () => { need(); return news() }, leave: leaveServer }

async function answer (line) {
  let id = null
  try {
    const told = JSON.parse(line)
    id = told.id
    if (!Object.hasOwn(ACTS, told.do)) throw new Error(`no act is called ${told.do}`)
    say(JSON.stringify({ id, ...(await ACTS[told.do](told)) }) + '\n')
  } catch (error) {
    say(JSON.stringify({ id, error: String(error.message || error).split('\n')[0].slice(0, 500) }) + '\n')
  }
}

process.on('unhandledRejection', error => console.error(error))
process.on('uncaughtException', error => {
  console.error(error)
  leave(`the player failed: ${String(error.message || error).split('\n')[0].slice(0, 300)}`)
})

let rest = ''
process.stdin.setEncoding('utf8')
process.stdin.on('data', async text => {
  rest += text
  if (rest.length > MOST_LINE) process.exit(4)
  const lines = rest.split('\n')
  rest = lines.pop()
  for (const line of lines) if (line.trim()) await answer(line)
})
process.stdin.on('end', () => process.exit(0))
