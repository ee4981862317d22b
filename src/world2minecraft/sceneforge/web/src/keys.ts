// THE table of keys and gestures: what listens to keys, the help page, the palette, the tooltips and
// docs/reference/forge-keys.md are all made from it.

import type { Mode } from "./store";
import { TEXT } from "./text";

export type Group = keyof typeof TEXT.groups;

export const GROUPS = Object.keys(TEXT.groups) as Group[];

export interface Binding {
  id: string;
  keys: readonly string[]; // "Ctrl+Shift+Z"; Ctrl is Cmd on a Mac; a gesture has words here
  group: Group;
  title: string;
  modes?: readonly Mode[]; // where the key does this; everywhere where left out
  gesture?: true; // of the mouse: listed, not listened to
}

type Row = [id: keyof typeof TEXT.action, group: Group, keys: string[], modes?: Mode[]];

const VOXELS: Mode[] = ["voxels"];
const OBJECTS: Mode[] = ["objects"];
const FURNISHING: Mode[] = ["objects", "build"];
const BOTH: Mode[] = ["voxels", "objects"];
const VOXEL_VIEWS: Mode[] = ["inspect", "voxels", "objects"];
const LOOKING: Mode[] = ["inspect", "voxels", "objects", "build"];

const ROWS: Row[] = [
  ["help", "page", ["?", "F1"]],
  ["palette", "page", ["Ctrl+K"]],
  ["cancel", "page", ["Escape"]],
  ["save", "page", ["Ctrl+S"]],
  ["export", "page", ["Ctrl+E"]],
  ["theme", "page", []],
  ["start", "page", []],
  ["undo", "edit", ["Ctrl+Z"]],
  ["redo", "edit", ["Ctrl+Shift+Z", "Ctrl+Y"]],
  ["delete", "edit", ["Delete", "Backspace"], BOTH],
  ["mode.inspect", "modes", ["Shift+1"]],
  ["mode.voxels", "modes", ["Shift+2"]],
  ["mode.objects", "modes", ["Shift+3"]],
  ["mode.build", "modes", ["Shift+4"]],
  ["mode.walk", "modes", ["Shift+5", "V"]],
  ["view.focus", "view", ["F"], LOOKING],
  ["view.reset", "view", ["Shift+F"], LOOKING],
  ["view.top", "view", ["Numpad7"], LOOKING],
  ["view.front", "view", ["Numpad1"], LOOKING],
  ["view.side", "view", ["Numpad3"], LOOKING],
  ["view.ortho", "view", ["Numpad5"], LOOKING],
  ["camera.left", "view", ["Ctrl+ArrowLeft"], LOOKING],
  ["camera.right", "view", ["Ctrl+ArrowRight"], LOOKING],
  ["camera.up", "view", ["Ctrl+ArrowUp"], LOOKING],
  ["camera.down", "view", ["Ctrl+ArrowDown"], LOOKING],
  ["camera.panLeft", "view", ["Shift+ArrowLeft"], LOOKING],
  ["camera.panRight", "view", ["Shift+ArrowRight"], LOOKING],
  ["camera.panUp", "view", ["Shift+ArrowUp"], LOOKING],
  ["camera.panDown", "view", ["Shift+ArrowDown"], LOOKING],
  ["camera.closer", "view", ["Shift+PageUp"], LOOKING],
  ["camera.away", "view", ["Shift+PageDown"], LOOKING],
  ["view.hide", "view", ["\\"], LOOKING],
  ["view.unhide", "view", ["Shift+\\"], LOOKING],
  ["view.solo", "view", ["O"], LOOKING],
  ["view.edges", "view", ["E"], VOXEL_VIEWS],
  ["slice.up", "view", ["PageUp"], LOOKING],
  ["slice.down", "view", ["PageDown"], LOOKING],
  ["photo.way", "photos", ["P"], LOOKING],
  ["photo.leave", "photos", []],
  ["doubtful.next", "view", ["."], LOOKING],
  ["doubtful.previous", "view", [","], LOOKING],
  ["tool.navigate", "tools", ["Q"], LOOKING],
  ["tool.measure", "tools", ["J"], LOOKING],
  ["tool.eyedropper", "tools", ["I"], BOTH],
  ["tool.brush", "tools", ["B"], VOXELS],
  ["tool.erase", "tools", ["Shift+B"], VOXELS],
  ["tool.box", "tools", ["X"], VOXELS],
  ["tool.lasso", "tools", ["L"], VOXELS],
  ["tool.flood", "tools", ["K"], VOXELS],
  ["brush.smaller", "tools", ["["], VOXELS],
  ["brush.larger", "tools", ["]"], VOXELS],
  ["brush.shape", "tools", ["Shift+X"], VOXELS],
  ["surface", "tools", ["U"], VOXELS],
  ["cursor.right", "voxels", ["ArrowRight"], VOXELS],
  ["cursor.left", "voxels", ["ArrowLeft"], VOXELS],
  ["cursor.away", "voxels", ["ArrowUp"], VOXELS],
  ["cursor.near", "voxels", ["ArrowDown"], VOXELS],
  ["cursor.up", "voxels", ["Alt+ArrowUp"], VOXELS],
  ["cursor.down", "voxels", ["Alt+ArrowDown"], VOXELS],
  ["cursor.paint", "voxels", ["Space"], VOXELS],
  ["cursor.erase", "voxels", ["Shift+Space"], VOXELS],
  ["cells.relabel", "voxels", ["Enter"], VOXELS],
  ["cells.fillBox", "voxels", ["Shift+Enter"], VOXELS],
  ["cells.smooth", "voxels", ["Shift+S"], VOXELS],
  ["cells.copy", "voxels", ["Ctrl+C"], VOXELS],
  ["cells.paste", "voxels", ["Ctrl+V"], VOXELS],
  ["cells.component", "voxels", ["Shift+Delete"], VOXELS],
  ["holes.fill", "voxels", ["H"], VOXELS],
  ["floaters.find", "voxels", ["Shift+H"], VOXELS],
  ["select.all", "selection", ["Ctrl+A"], BOTH],
  ["select.none", "selection", ["Ctrl+Shift+A"], BOTH],
  ["select.invert", "selection", ["Ctrl+I"], BOTH],
  ["select.undo", "selection", ["Alt+Z"], BOTH],
  ["select.redo", "selection", ["Alt+Shift+Z"], BOTH],
  ["tool.move", "objects", ["G"], OBJECTS],
  ["tool.add", "objects", ["N"], OBJECTS],
  ["object.turn", "objects", ["R"], FURNISHING],
  ["object.turnBack", "objects", ["Shift+R"], FURNISHING],
  ["object.template", "objects", ["T"], FURNISHING],
  ["object.templateBack", "objects", ["Shift+T"], FURNISHING],
  ["object.split", "objects", ["S"], OBJECTS],
  ["object.merge", "objects", ["M"], OBJECTS],
  ["object.duplicate", "objects", ["D"], OBJECTS],
  ["object.floor", "objects", ["C"], OBJECTS],
  ["object.wall", "objects", ["Shift+C"], OBJECTS],
  ["object.relabel", "objects", ["Enter"], OBJECTS],
  ["object.rematch", "objects", ["Shift+M"], OBJECTS],
  ["walk.ask", "walk", ["G"], ["inspect", "build", "walk"]],
  ["object.next", "objects", ["ArrowRight"], OBJECTS],
  ["object.previous", "objects", ["ArrowLeft"], OBJECTS],
];

const CLASS_KEYS = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "0", "-", "="];

/** The class of each key: 1 to 11 by their ids, and = for empty. */
const CLASS_BINDINGS: Binding[] = CLASS_KEYS.map((key, at) => ({
  id: `class.${(at + 1) % 12}`,
  keys: [key],
  group: "classes",
  title: TEXT.pickClass((at + 1) % 12),
  modes: BOTH,
}));

const GESTURES: Binding[] = TEXT.gestures.map(([id, group, words, title]) => ({
  id,
  keys: [words],
  group,
  title,
  gesture: true,
}));

export const BINDINGS: readonly Binding[] = [
  ...ROWS.map(([id, group, keys, modes]) => ({ id, keys, group, title: TEXT.action[id], modes })),
  ...CLASS_BINDINGS,
  ...GESTURES,
];

export function bindingOf(id: string): Binding | undefined {
  return BINDINGS.find((one) => one.id === id);
}

/** The binding that a key stroke means in a mode. */
export function bindingFor(stroke: Stroke, mode: Mode): Binding | undefined {
  const name = strokeName(stroke);
  return BINDINGS.find(
    (one) =>
      !one.gesture && (!one.modes || one.modes.includes(mode)) && one.keys.some((k) => k === name),
  );
}

export type Stroke = Pick<KeyboardEvent, "key" | "code" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">;

/** "Ctrl+Shift+Z" of what was pressed. Digits and brackets count by their place on the board. */
export function strokeName(stroke: Stroke): string {
  const key = keyName(stroke);
  const shift = stroke.shiftKey && key !== "?";
  const held = [(stroke.ctrlKey || stroke.metaKey) && "Ctrl", stroke.altKey && "Alt", shift && "Shift"];
  return [...held.filter(Boolean), key].join("+");
}

const BY_PLACE: Record<string, string> = {
  Backslash: "\\",
  BracketLeft: "[",
  BracketRight: "]",
  Minus: "-",
  Equal: "=",
};

function keyName({ key, code }: Stroke): string {
  if (key === " ") return "Space";
  if (code.startsWith("Digit")) return code.slice(5);
  if (code.startsWith("Numpad") && /\d$/.test(code)) return code;
  if (key === "?" || key.length > 1) return key;
  return BY_PLACE[code] ?? key.toUpperCase();
}
