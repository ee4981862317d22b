// Starts a server on a world folder, joins a player, and says what the player meets.
//
// node walk.js PLAN.json: the plan names the world, the version, blocks to look at, where to
// start, in which direction to walk for how long, and the file for the answer.

const fs = require('fs')
const { Vec3 } = require('vec3')
const mineflayer = require('mineflayer')
const startServer = require('./server.js')

const plan = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'))
const wait = (milliseconds) => new Promise(resolve => setTimeout(resolve, milliseconds))

function fail (reason) {
  console.error(String(reason && reason.stack ? reason.stack : reason))
  process.exit(1)
}
process.on('unhandledRejection', fail)
process.on('uncaughtException', fail)
setTimeout(() => fail('the walk took longer than its limit'), plan.limit_s * 1000)

function stateOf (block) {
  if (!block) return null
  const properties = block.getProperties()
  const names = Object.keys(properties).sort()
  const text = names.map(name => `${name}=${properties[name]}`).join(',')
  return `minecraft:${block.name}` + (text ? `[${text}]` : '')
}

async function main () {
  const server = startServer(plan)
  await server.waitForReady(20000)
  // The server looks for ground from layer 81 down, for ever in a void: it is told the spawn.
  server.getSpawnPoint = async () => new Vec3(...plan.start)
  const bot = mineflayer.createBot({
    host: '127.0.0.1', port: plan.port, username: 'walker', auth: 'offline', version: plan.version
  })
  bot.on('kicked', fail)
  bot.on('error', fail)
  await new Promise(resolve => bot.once('spawn', resolve))
  const [x, y, z] = plan.start
  const goTo = () => bot.chat(`/tp walker ${x} ${y} ${z}`)
  for (let tries = 0; tries < 40; tries++) {
    goTo()
    await wait(250)
    if (bot.entity.position.distanceTo(new Vec3(x, y, z)) < 1 && bot.entity.onGround) break
  }
  await bot.waitForChunksToLoad()
  const seen = plan.blocks.map(place => stateOf(bot.blockAt(new Vec3(...place))))
  const from = bot.entity.position.clone()
  await bot.look(plan.yaw, 0, true)
  bot.setControlState('forward', true)
  const heights = []
  for (let step = 0; step < plan.walk_s * 10; step++) {
    await wait(100)
    heights.push(bot.entity.position.y)
  }
  bot.setControlState('forward', false)
  const to = bot.entity.position
  fs.writeFileSync(plan.answer, JSON.stringify({
    seen, from: from.toArray(), to: to.toArray(), heights, on_ground: bot.entity.onGround
  }))
  process.exit(0)
}

main().catch(fail)
