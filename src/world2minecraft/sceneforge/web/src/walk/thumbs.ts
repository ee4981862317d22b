// Thumbs of one who walks on a touch screen: the left one holds a stick, the right one looks around.

import "./thumbs.css";
import { h } from "../ui/dom";
import { NO_KEYS, type Keys } from "./body";
import type { Extra } from "./input";

const REST = 0.28; // of the stick's reach: nearer to its middle it stands still
const RUN = 0.98; // and so far out it runs
const LOOK_DEG_PX = 0.32;
const TAP_PX = 9; // a touch that moves less is a tap
const TAP_MS = 400;
const OCTANTS: readonly (readonly (keyof Keys)[])[] = [
  ["right"],
  ["right", "back"],
  ["back"],
  ["back", "left"],
  ["left"],
  ["left", "forward"],
  ["forward"],
  ["forward", "right"],
];

/** The keys that a stick holds down; right and down are positive, 1 is as far as it goes. */
export function keysOfStick(x: number, y: number): Keys {
  const keys = { ...NO_KEYS };
  const reach = Math.hypot(x, y);
  if (reach < REST) return keys;
  const octant = (Math.round((Math.atan2(y, x) * 4) / Math.PI) + 8) % 8;
  for (const name of OCTANTS[octant]!) keys[name] = true;
  keys.sprint = keys.forward && reach >= RUN;
  return keys;
}

export interface ThumbWords {
  stick: string;
  look: string;
  jump: string;
}

export class Thumbs implements Extra {
  readonly node: HTMLElement;
  private held: Keys = NO_KEYS;
  private jumps = false;
  private turned: [number, number] = [0, 0];

  constructor(words: ThumbWords, calls: { moved(): void; tapped(x: number, y: number): void }) {
    const knob = h("div", { class: "thumb-knob" });
    const stick = h("div", { class: "thumb-stick", role: "img", "aria-label": words.stick }, knob);
    const pad = h("div", { class: "thumb-pad", role: "img", "aria-label": words.look });
    const jump = h("button", { class: "thumb-jump", type: "button", "aria-label": words.jump }, "↑");
    this.node = h("div", { class: "thumbs" }, pad, stick, jump);
    follow(stick, {
      move: ({ x, y }) => {
        const box = stick.getBoundingClientRect();
        const [right, down] = [(x - box.left) / box.width, (y - box.top) / box.height].map((v) => 2 * v - 1) as [number, number];
        const reach = Math.max(Math.hypot(right, down), 1);
        this.held = keysOfStick(right / reach, down / reach);
        knob.style.setProperty("transform", `translate(${(right / reach) * 70}%, ${(down / reach) * 70}%)`);
        calls.moved();
      },
      end: () => {
        this.held = NO_KEYS;
        knob.style.removeProperty("transform");
      },
    });
    this.followPad(pad, calls);
    const hold = (on: boolean) => () => {
      this.jumps = on;
      calls.moved();
    };
    for (const [type, on] of [["pointerdown", true], ["pointerup", false], ["pointercancel", false], ["pointerleave", false]] as const) jump.addEventListener(type, hold(on));
  }

  get keys(): Keys {
    return { ...this.held, jump: this.jumps };
  }

  look(): [number, number] {
    const turned = this.turned;
    this.turned = [0, 0];
    return turned;
  }

  private followPad(pad: HTMLElement, calls: { moved(): void; tapped(x: number, y: number): void }): void {
    let [last, began, gone] = [{ x: 0, y: 0 }, 0, 0];
    follow(pad, {
      start: (at) => {
        [last, began, gone] = [at, performance.now(), 0];
      },
      move: (at) => {
        this.turned[0] += (at.x - last.x) * LOOK_DEG_PX;
        this.turned[1] += (at.y - last.y) * LOOK_DEG_PX;
        gone += Math.hypot(at.x - last.x, at.y - last.y);
        last = at;
        calls.moved();
      },
      end: () => {
        if (gone < TAP_PX && performance.now() - began < TAP_MS) calls.tapped(last.x, last.y);
      },
    });
  }
}

interface At {
  x: number;
  y: number;
}

/** Follow one finger that came down on an element, wherever it goes. */
function follow(node: HTMLElement, calls: { start?(at: At): void; move(at: At): void; end(): void }): void {
  let id = -1;
  const ours = (event: PointerEvent): boolean => event.pointerId === id;
  const at = (event: PointerEvent): At => ({ x: event.clientX, y: event.clientY });
  node.addEventListener("pointerdown", (event) => {
    if (id >= 0) return;
    id = event.pointerId;
    try {
      node.setPointerCapture(id);
    } catch {
      // The pointer is gone already, as for events that a script made.
    }
    event.preventDefault();
    calls.start?.(at(event));
    if (!calls.start) calls.move(at(event));
  });
  node.addEventListener("pointermove", (event) => ours(event) && calls.move(at(event)));
  for (const type of ["pointerup", "pointercancel"] as const) {
    node.addEventListener(type, (event) => {
      if (!ours(event)) return;
      id = -1;
      calls.end();
    });
  }
}
