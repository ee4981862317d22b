// The annotation page: a walk as pictures, and what to tell somebody who is to walk it.

const LEVELS = {
  goal: goal => `Describe only the destination, as for someone who knows the place. The walk ends at the ${goal}.`,
  route: () => 'Describe only turns and distances. Do not name objects.',
  landmark: goal => `Describe the route by landmarks, for example: past the table, left at the sofa. The walk ends at the ${goal}.`
}
const DOES = { 'move forward': 'next: move forward', 'turn left': 'next: turn left', 'turn right': 'next: turn right', stop: 'stop' }
const FRAME_MS = 700
const CHECK_MS = 350

const at = id => document.getElementById(id)
const state = { walks: [], walk: null, frame: 0, level: 'goal', texts: {}, timer: 0, checking: 0 }

async function ask (path, body) {
  const options = body && { method: 'POST', body: JSON.stringify(body), headers: { 'content-type': 'application/json' } }
  const answer = await fetch(`/api/${path}`, options || {})
  const told = await answer.json().catch(() => ({ error: 'the server does not respond; check that it is running' }))
  if (!answer.ok) throw new Error(told.error)
  return told
}

function element (name, text, attributes = {}) {
  const made = document.createElement(name)
  made.textContent = text
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value)
  return made
}

async function list () {
  const told = await ask('walks')
  state.walks = told.walks
  at('where').textContent = `Output file: ${told.file}`
  showList()
}

function showList () {
  const rows = state.walks.filter(one => !at('open').checked || !one.written || one.number === state.walk?.number)
  at('walks').replaceChildren(...rows.map(one => {
    const button = element('button', `${one.scene} → ${one.goal || 'unnamed goal'}`, { type: 'button' })
    button.append(element('small', `${one.path_m} m, ${one.frames} images` + (one.written ? `, ${one.written} written` : '')))
    button.setAttribute('aria-current', String(one.number === state.walk?.number))
    button.addEventListener('click', () => open(one.number))
    const row = element('li', '')
    row.append(button)
    return row
  }))
}

async function open (number) {
  stop()
  state.walk = await ask(`walk/${number}`)
  state.texts = {}
  at('said').textContent = ''
  at('slider').max = state.walk.frames.length - 1
  at('strip').replaceChildren(...state.walk.frames.map((move, frame) => {
    const button = element('button', '', { type: 'button' })
    button.append(element('img', '', { src: `/api/image/${number}/${frame}`, alt: `Image ${frame + 1}`, loading: 'lazy' }))
    button.addEventListener('click', () => { stop(); show(frame) })
    const row = element('li', '')
    row.append(button)
    return row
  }))
  at('things').textContent = state.walk.things.join(', ') || 'No named objects'
  showTold()
  showList()
  choose('goal')
  show(0)
}

function show (frame) {
  state.frame = frame
  const { number, frames } = state.walk
  at('view').src = `/api/image/${number}/${frame}`
  at('caption').textContent = DOES[frames[frame]] || frames[frame]
  at('slider').value = frame
  at('count').textContent = `${frame + 1} / ${frames.length}`
  const buttons = [...at('strip').querySelectorAll('button')]
  buttons.forEach((one, n) => one.setAttribute('aria-current', String(n === frame)))
  const strip = at('strip')
  strip.scrollLeft = buttons[frame].offsetLeft - strip.offsetLeft - strip.clientWidth / 2
}

function stop () {
  clearInterval(state.timer)
  state.timer = 0
  at('play').textContent = 'Play'
}

function play () {
  if (state.timer) return stop()
  if (state.frame === state.walk.frames.length - 1) show(0)
  at('play').textContent = 'Pause'
  state.timer = setInterval(() => {
    if (state.frame === state.walk.frames.length - 1) stop()
    else show(state.frame + 1)
  }, FRAME_MS)
}

function choose (level) {
  state.level = level
  for (const button of at('levels').children) button.setAttribute('aria-selected', String(button.dataset.level === level))
  at('asked').textContent = LEVELS[level](state.walk.goal || 'last image')
  at('text').value = state.texts[level] || ''
  at('said').textContent = ''
  check()
}

async function check () {
  const mine = ++state.checking
  const text = at('text').value
  state.texts[state.level] = text
  if (!text.trim()) {
    at('keep').disabled = true
    return at('findings').replaceChildren()
  }
  const { findings } = await ask('check', { number: state.walk.number, level: state.level, text })
  if (mine !== state.checking) return // A later letter was checked.
  at('keep').disabled = findings.some(one => one.is_wrong)
  const rows = findings.map(one => element('li', one.text, { class: one.is_wrong ? 'wrong' : 'hint' }))
  at('findings').replaceChildren(...(rows.length ? rows : [element('li', 'No problems found.', { class: 'good' })]))
}

async function keep (event) {
  event.preventDefault()
  const said = at('said')
  said.className = ''
  try {
    const fields = { number: state.walk.number, level: state.level, text: at('text').value }
    await ask('add', { ...fields, annotator: at('annotator').value, language: at('language').value })
  } catch (error) {
    said.className = 'wrong'
    said.textContent = error.message
    if (!at('annotator').value.trim()) at('annotator').focus()
    return
  }
  const number = state.walk.number
  state.walk = await ask(`walk/${number}`)
  state.texts[state.level] = ''
  at('levels').querySelector(`[data-level=${state.level}]`).classList.add('kept')
  showTold()
  await list()
  const left = Object.keys(LEVELS).find(level => !at('levels').querySelector(`[data-level=${level}]`).classList.contains('kept'))
  if (left) choose(left)
  else await openNext(number)
  said.textContent = left ? 'Saved. Describe the same walk at the next level.' : 'Saved. Next walk.'
}

async function openNext (number) {
  const rest = [...state.walks.slice(number + 1), ...state.walks.slice(0, number)]
  await open((rest.find(one => !one.written) || rest[0] || state.walks[0]).number)
  for (const button of at('levels').children) button.classList.remove('kept')
}

function showTold () {
  const told = state.walk.told
  at('others').querySelector('summary').textContent = `Existing instructions (${told.length})`
  at('told').replaceChildren(...told.map(one => element('li', `${one.text} — ${one.level}, ${one.by}`)))
}

function remember (id) {
  at(id).value = localStorage.getItem(`w2m-${id}`) || at(id).value
  at(id).addEventListener('change', () => localStorage.setItem(`w2m-${id}`, at(id).value))
}

let waiting = 0
at('text').addEventListener('input', () => {
  clearTimeout(waiting)
  waiting = setTimeout(check, CHECK_MS)
})
at('levels').replaceChildren(...Object.keys(LEVELS).map(level => {
  const button = element('button', level, { type: 'button', role: 'tab', 'data-level': level })
  button.addEventListener('click', () => choose(level))
  return button
}))
at('form').addEventListener('submit', keep)
at('play').addEventListener('click', play)
at('open').addEventListener('change', showList)
at('slider').addEventListener('input', () => { stop(); show(Number(at('slider').value)) })
remember('annotator')
remember('language')
await list()
await open((state.walks.find(one => !one.written) || state.walks[0]).number)
