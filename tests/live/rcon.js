// Starts a server with a console on a world folder and serves until it is told to stop.
//
// node rcon.js PLAN.json: the plan names the world, the version, the game's port and the console.

const fs = require('fs')
const path = require('path')
const { createMCServer } = require('flying-squid')
const startConsole = require('./console.js')

const plan = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))
const fail = reason => {
  console.error(String(reason && reason.stack ? reason.stack : reason))
  process.exit(1)
}
process.on('unhandledRejection', fail)
setTimeout(() => fail('the server ran longer than its limit'), plan.limit_s * 1000)

async function main () {
  const server = createMCServer({
    host: '127.0.0.1',
    port: plan.port,
    'online-mode': false,
    'max-players': 1,
    logging: false,
    gameMode: 1,
    difficulty: 0,
    worldFolder: plan.world,
    generation: { name: path.join(__dirname, 'void.js'), options: {} },
    kickTimeout: 10000,
    plugins: {},
    modpe: false,
    'view-distance': 3,
    'player-list-text': { header: { text: '' }, footer: { text: '' } },
    'everybody-op': true,
    'max-entities': 10,
    version: plan.version
  })
  await server.waitForReady(20000)
  startConsole(server, require('prismarine-registry')(plan.version), plan.console)
}

main().catch(fail)
