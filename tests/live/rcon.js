// Starts a server with a console on a world folder and serves until it is told to stop.
//
// node rcon.js PLAN.json: the plan names the world, the version, the game's port and the console.

const fs = require('fs')
const startConsole = require('./console.js')
const startServer = require('./server.js')

const plan = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))
const fail = reason => {
  console.error(String(reason && reason.stack ? reason.stack : reason))
  process.exit(1)
}
process.on('unhandledRejection', fail)
setTimeout(() => fail('the server ran longer than its limit'), plan.limit_s * 1000)

async function main () {
  const server = startServer(plan)
  await server.waitForReady(20000)
  startConsole(server, require('prismarine-registry')(plan.version), plan.console)
}

main().catch(fail)
