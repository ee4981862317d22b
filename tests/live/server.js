// A server of the test's kind on a world folder: a void, creative mode, everybody an operator.

const path = require('path')
const { createMCServer } = require('flying-squid')

module.exports = plan => createMCServer({
  host: '127.0.0.1',
  port: plan.port,
  'online-mode': false,
  'max-players': 2,
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
