// All that a shared page says.

export const TEXT = {
  views: { look: "From above", walk: "Walk" },
  viewsLabel: "View",
  day: "Day",
  night: "Night",
  light: "Time of day",
  whole: "Reset view",
  photos: "Photos",
  things: "Things",
  thingsCount: (count: number): string => `${count} ${count === 1 ? "thing" : "things"}`,
  ask: {
    label: "Where to?",
    go: "Go",
    hint: (name: string): string => `go to the ${name}`,
    nothing: "Type what to go to, such as the sofa.",
  },
  goThere: "Walk there",
  close: "Close",
  canvas: "The room in 3D. Arrow keys turn it, plus and minus zoom.",
  facts: (size: readonly [number, number, number] | null, count: number): string => {
    const things = `${count} ${count === 1 ? "thing" : "things"}`;
    return size ? `${metres(size[0])} × ${metres(size[1])} m · ${things}` : things;
  },
  size: ([a, b, c]: readonly [number, number, number]): string =>
    `${metres(Math.max(a, b))} × ${metres(Math.min(a, b))} m, ${metres(c)} m high`,
  walking: (name: string, away: number, of: number): string =>
    of > 1 ? `To the nearest of ${of}: ${name}, ${metres(away)} m.` : `Walking to the ${name}, ${metres(away)} m.`,
  arrived: (name: string): string => `Here is the ${name}.`,
  noWay: (name: string): string => `No way leads to the ${name} from here.`,
  noWalk: "There is nowhere to stand in this room.",
  unknown: (text: string): string => `There is no “${text}” here. Try one of these:`,
  soon: "The floor is still being read. Try again in a moment.",
  walkHint: "W A S D to walk, click to look around, Esc to leave.",
  thumbs: { stick: "Stick for the left thumb: walk", look: "Drag to look around", jump: "Jump" },
  photo: (n: number, of: number): string => `Photo ${n} of ${of}`,
  photoCount: (n: number, of: number): string => `${n} of ${of}`,
  slider: "Photo or room",
  before: "Photo",
  after: "Room",
  previous: "Previous photo",
  next: "Next photo",
  closePhotos: "Close photos",
  noView: "This browser cannot draw the room: it needs WebGL 2. A current Firefox, Chrome, Edge or Safari can.",
  broken: "The room in this file cannot be read. The file may be incomplete; ask for it again.",
  made: "Made with World2Minecraft",
};

function metres(value: number): string {
  return value.toFixed(1);
}

export function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
