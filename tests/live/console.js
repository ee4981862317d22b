// A plugin for the test server: RCON with the few commands that a build needs, under the game's
// rules, for flying-squid has neither. Before command number `cut` it hangs up; of number `stall` it
// says nothing, but for a file that the test waits for.

const net = require('net')
const fs = require('fs')
const { Vec3 } = require('vec3')

const POINT = '(-?\\d+) (-?\\d+) (-?\\d+)'
const MAX_FILL = 32768
const MAX_REQUEST = 1460

module.exports = function startConsole (server, registry, { port, password, cut, stall, stalled }) {
  const Block = require('prismarine-block')(registry)
  const world = server.overworld
  const left = new Set([cut, stall])
  let count = 0

  function stateId (text) {
    const found = /^minecraft:([a-z0-9_]+)(?:\[(.*)\])?$/.exec(text)
    const type = found && registry.blocksByName[found[1]]
    if (!type) return null
    const given = (found[2] || '').split(',').filter(Boolean).map(pair => pair.split('='))
    const values = Object.fromEntries(given.map(([key, value]) =>
      [key, value === 'true' ? true : value === 'false' ? false : /^\d+$/.test(value) ? Number(value) : value]))
    // What a command leaves out is the default's, also of properties that older games lack.
    const usual = Block.fromStateId(type.defaultState, 0).getProperties()
    return Block.fromProperties(type.id, { ...usual, ...values }, 0).stateId
  }

  async function fill (ends, state) {
    const id = stateId(state)
    if (id === null) return `Unknown block type '${state}'`
    const [x0, y0, z0, x1, y1, z1] = ends
    const volume = (x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1)
    if (volume > MAX_FILL) return `Too many blocks in the specified area (maximum ${MAX_FILL}, specified ${volume})`
    let changed = 0
    for (let x = x0; x <= x1; x++) {
      for (let y = y0; y <= y1; y++) {
        for (let z = z0; z <= z1; z++) {
          const place = new Vec3(x, y, z)
          if (await world.getBlockStateId(place) === id) continue
          await world.setBlockStateId(place, id)
          changed++
        }
      }
    }
    return changed ? `Successfully filled ${changed} block(s)` : 'No blocks were filled'
  }

  async function dump (ends, file) {
    const [x0, y0, z0, x1, y1, z1] = ends
    const states = []
    for (let x = x0; x <= x1; x++) {
      for (let y = y0; y <= y1; y++) {
        for (let z = z0; z <= z1; z++) {
          const block = await world.getBlock(new Vec3(x, y, z))
          const properties = block.getProperties()
          const names = Object.keys(properties).sort()
          const text = names.map(name => `${name}=${properties[name]}`).join(',')
          states.push(`minecraft:${block.name}` + (text ? `[${text}]` : ''))
        }
      }
    }
    fs.writeFileSync(file, JSON.stringify(states))
    return 'dumped'
  }

  async function run (text) {
    const numbers = found => found.slice(1, 7).map(Number)
    let found = new RegExp(`^setblock ${POINT} (\\S+)$`).exec(text)
    if (found) return fill([...found.slice(1, 4), ...found.slice(1, 4)].map(Number), found[4])
    found = new RegExp(`^fill ${POINT} ${POINT} (\\S+)$`).exec(text)
    if (found) return fill(numbers(found), found[7])
    found = new RegExp(`^execute if loaded ${POINT}$`).exec(text)
    if (found) {
      const [x, , z] = found.slice(1).map(Number)
      return await world.getColumn(x >> 4, z >> 4) ? 'Test passed' : 'Test failed'
    }
    found = new RegExp(`^execute if block ${POINT} (\\S+)$`).exec(text)
    if (found) {
      const block = await world.getBlock(new Vec3(...found.slice(1, 4).map(Number)))
      const [, name, given] = /^minecraft:([a-z0-9_]+)(?:\[(.*)\])?$/.exec(found[4]) || []
      // The game compares the properties that are stated, and no more.
      const pairs = (given || '').split(',').filter(Boolean).map(pair => pair.split('='))
      const has = block.getProperties()
      const same = block.name === name && pairs.every(([key, value]) => String(has[key]) === value)
      return same ? 'Test passed' : 'Test failed'
    }
    found = new RegExp(`^dump ${POINT} ${POINT} (.+)$`).exec(text)
    if (found) return dump(numbers(found), found[7])
    if (/^forceload (add|remove) /.test(text)) return 'Marked 1 chunks'
    if (/^(data merge block|kill @e|summon) /.test(text)) return 'Done'
    if (text === 'stop') setTimeout(() => process.exit(0), 100)
    if (text === 'stop') return 'Stopping'
    return 'Unknown or incomplete command, see below for error<--[HERE]'
  }

  net.createServer(socket => {
    let known = false
    socket.on('error', () => {})
    socket.on('data', async data => {
      // The game reads one packet a call and hangs up on anything else.
      if (data.length > MAX_REQUEST || data.length < 14 || data.readInt32LE(0) !== data.length - 4) return socket.destroy()
      const id = data.readInt32LE(4)
      const text = data.toString('utf8', 12, data.length - 2)
      const send = (number, kind, body) => {
        const bytes = Buffer.from(body)
        const packet = Buffer.alloc(14 + bytes.length)
        packet.writeInt32LE(10 + bytes.length, 0)
        packet.writeInt32LE(number, 4)
        packet.writeInt32LE(kind, 8)
        bytes.copy(packet, 12)
        socket.write(packet)
      }
      if (data.readInt32LE(8) === 3) {
        known = text === password
        return send(known ? id : -1, 2, '')
      }
      if (!known) return send(-1, 2, '')
      if (left.delete(count)) return count === cut ? socket.destroy() : fs.writeFileSync(stalled, '')
      count++
      try {
        send(id, 0, await run(text))
      } catch (error) {
        send(id, 0, `An unexpected error occurred trying to execute that command: ${error}`)
      }
    })
  }).listen(port, '127.0.0.1')
}
