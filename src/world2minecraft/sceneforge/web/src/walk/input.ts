// Keys and mouse of one who walks. With the mouse free, arrows turn and look: a keyboard is enough.

import { NO_KEYS, type Keys } from "./body";

const HELD: Record<string, keyof Keys> = {
  KeyW: "forward",
  KeyS: "back",
  KeyA: "left",
  KeyD: "right",
  Space: "jump",
  ShiftLeft: "sneak",
  ShiftRight: "sneak",
  KeyR: "sprint",
};
const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const TURN_DEG_S = 110; // by arrows
const DEG_PX = 0.15; // by the mouse, as the game at its usual setting
const TWICE_MS = 300; // W twice within: a sprint

/** Another way to walk and look, beside keys and mouse. */
export interface Extra {
  readonly keys: Keys;
  /** Degrees to the right and down since this was last asked. */
  look(): [number, number];
}

export class Input {
  private readonly down = new Set<string>();
  private lastForward = -Infinity;
  private runs = false;
  private turned: [number, number] = [0, 0];
  private ends: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly calls: { leave(): void; moved(): void },
    private readonly extra: Extra | null = null,
  ) {}

  start(): void {
    this.on(window, "keydown", (event: KeyboardEvent) => this.press(event));
    this.on(window, "keyup", (event: KeyboardEvent) => this.release(event.code));
    this.on(window, "blur", () => this.clear());
    this.on(document, "pointerlockchange", () => this.lockChanged());
    this.on(document, "mousemove", (event: MouseEvent) => this.move(event));
    this.on(this.canvas, "click", () => void this.lock());
  }

  stop(): void {
    for (const end of this.ends.splice(0)) end();
    if (this.isLocked) document.exitPointerLock();
    this.clear();
  }

  get isLocked(): boolean {
    return document.pointerLockElement === this.canvas;
  }

  get isHeld(): boolean {
    return this.down.size > 0;
  }

  get keys(): Keys {
    const keys = { ...NO_KEYS };
    for (const code of this.down) if (HELD[code]) keys[HELD[code]] = true;
    keys.sprint ||= this.runs && keys.forward;
    const more = this.extra?.keys ?? NO_KEYS;
    for (const name of Object.keys(keys) as (keyof Keys)[]) keys[name] ||= more[name];
    return keys;
  }

  /** Degrees to the right and down since this was last asked. */
  look(milliseconds: number): [number, number] {
    const [right, down] = this.turned;
    this.turned = [0, 0];
    const by = (TURN_DEG_S * milliseconds) / 1000;
    const [moreX, moreY] = this.extra?.look() ?? [0, 0];
    let [x, y] = [right + moreX, down + moreY];
    for (const code of this.down) {
      x += (ARROWS[code]?.[0] ?? 0) * by;
      y += (ARROWS[code]?.[1] ?? 0) * by;
    }
    return [x, y];
  }

  private press(event: KeyboardEvent): void {
    if (event.code === "Escape") {
      event.preventDefault();
      this.calls.leave();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || inField(event.target)) return;
    if (!HELD[event.code] && !ARROWS[event.code]) return;
    event.preventDefault();
    if (event.repeat) return;
    if (event.code === "KeyW") {
      this.runs = event.timeStamp - this.lastForward < TWICE_MS;
      this.lastForward = event.timeStamp;
    }
    this.down.add(event.code);
    this.calls.moved();
  }

  private release(code: string): void {
    this.down.delete(code);
    if (code === "KeyW") this.runs = false;
  }

  private clear(): void {
    this.down.clear();
    this.runs = false;
  }

  private move(event: MouseEvent): void {
    if (!this.isLocked) return;
    this.turned[0] += event.movementX * DEG_PX;
    this.turned[1] += event.movementY * DEG_PX;
    this.calls.moved();
  }

  private async lock(): Promise<void> {
    try {
      await this.canvas.requestPointerLock();
    } catch {
      // Refused, as right after Esc: arrows look.
    }
  }

  /** The browser takes Esc for itself while the mouse is caught: it means to leave. */
  private lockChanged(): void {
    if (!this.isLocked && document.hasFocus()) this.calls.leave();
  }

  private on(target: EventTarget, type: string, call: (event: never) => void): void {
    const listener = call as unknown as EventListener;
    target.addEventListener(type, listener, { capture: true });
    this.ends.push(() => target.removeEventListener(type, listener, { capture: true }));
  }
}

function inField(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest("input:not([type=checkbox]), select, textarea") !== null;
}
