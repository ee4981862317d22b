// A generator for the chunks that the world folder does not hold: nothing at all.
module.exports = ({ registry }) => {
  const Chunk = require('prismarine-chunk')(registry)
  return () => new Chunk({ minY: -64, worldHeight: 384 })
}
