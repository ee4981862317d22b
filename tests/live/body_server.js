// A server for the body's test: over HTTP it says where a player is, and sets a block.
//
// node body_server.js PLAN.json: the plan names the world, the version, the port of the game and
// that of HTTP (`control`), and the start.

const fs = require('fs')
const http = require('http')
const { Vec3 } = require('vec3')
const startServer = require('./server.js')

const plan = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))
const fail = reason => {
  console.error(String(reason && reason.stack ? reason.stack : reason))
  process.exit(1)
}
process.on('unhandledRejection', fail)
setTimeout(() => fail('the server ran longer than its limit'), plan.limit_s * 1000)

async function answer ({ where, block, at }, server, registry) {
  if (where) {
    const player = server.players.find(one => one.username === where)
    return player ? player.position.toArray() : null
  }
  await server.setBlock(server.overworld, new Vec3(...at), registry.blocksByName[block].defaultState)
  return true
}

async function main () {
  const server = startServer(plan)
  await server.waitForReady(20000)
  // The server looks for ground from layer 81 down, for ever in a void: it is told the spawn.
  server.getSpawnPoint = async () => new Vec3(...plan.start)
  const registry = require('prismarine-registry')(plan.version)
  http.createServer((request, response) => {
    const asked = JSON.parse(decodeURIComponent(request.url.slice(1)))
    answer(asked, server, registry).then(value => response.end(JSON.stringify(value)), fail)
  }).listen(plan.control, '127.0.0.1')
}

main().catch(fail)
