// Gives what the pointer does on the scene to the tool that is chosen, and keeps the one gesture
// that goes on. The view turns and moves the camera with all that no tool claims.

import type { App } from "../ui/slots";
import { takesText } from "../ui/dom";
import { Marks } from "./marks";
import type { Desk, Gesture, Press, Tool } from "./tool";

const CLICK_PX = 4; // a press that moved less is a click

export interface Ends {
  hover(at: Press | null): void;
  rightClick(at: Press, event: PointerEvent): void;
}

export class ToolManager {
  readonly desk: Desk;
  private tools = new Map<string, Tool>();
  private gesture: Gesture | null = null;
  private chosen: Tool | null = null;
  private right: { x: number; y: number } | null = null;

  constructor(
    private app: App,
    private ends: Ends,
  ) {
    const begin = (gesture: Gesture): void => void (this.gesture = gesture);
    this.desk = { app, selection: app.selection, marks: new Marks(app.stage), begin };
    app.view.controls.claims = (event) => this.claims(event);
    this.listen();
    app.store.watch(["tool"], ({ tool }) => this.choose(tool));
  }

  add(tool: Tool): void {
    this.tools.set(tool.id, tool);
    if (tool.id === this.app.store.get().tool) this.choose(tool.id);
  }

  get busy(): boolean {
    return this.gesture !== null;
  }

  /** Cancel the gesture that goes on; whether there was one. */
  cancel(): boolean {
    const gesture = this.gesture;
    this.gesture = null;
    gesture?.cancel();
    return gesture !== null;
  }

  private choose(id: string): void {
    const tool = this.tools.get(id) ?? null;
    if (tool === this.chosen) return;
    this.cancel();
    this.chosen?.hover?.(null);
    this.chosen?.stop?.();
    this.chosen = tool;
    this.app.canvas.style.cursor = tool?.cursor ?? "default";
    tool?.start?.();
  }

  private claims(event: PointerEvent): boolean {
    if (this.gesture) return true;
    const tool = this.chosen;
    return tool !== null && (tool.claims ? tool.claims(this.pressOf(event)) : true);
  }

  private listen(): void {
    const { canvas } = this.app;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", () => this.hover(null));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    window.addEventListener("keydown", (event) => this.key(event), true);
  }

  private down(event: PointerEvent): void {
    this.app.canvas.focus({ preventScroll: true });
    if (event.button === 2) this.right = { x: event.clientX, y: event.clientY };
    if (event.button !== 0) return;
    const at = this.pressOf(event);
    if (this.gesture?.sticks) {
      this.finish(at);
      return;
    }
    if (!this.claims(event) || this.gesture) return;
    this.gesture = this.chosen?.press(at) ?? null;
    if (this.gesture && event.isTrusted) this.app.canvas.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    const at = this.pressOf(event);
    this.app.pointer.at = at;
    if (this.gesture) this.gesture.move(at);
    else this.hover(this.app.view.controls.dragging ? null : at);
    this.ends.hover(at);
  }

  private up(event: PointerEvent): void {
    const at = this.pressOf(event);
    if (event.button === 2 && this.right) {
      const moved = Math.hypot(event.clientX - this.right.x, event.clientY - this.right.y);
      this.right = null;
      if (moved < CLICK_PX && !this.cancel()) this.ends.rightClick(at, event);
    } else if (event.button === 0 && this.gesture && !this.gesture.sticks) this.finish(at);
  }

  /** Ctrl and the wheel size the brush; the wheel alone always zooms. */
  private wheel(event: WheelEvent): void {
    const sized = this.chosen?.id === "brush" || this.chosen?.id === "erase";
    if (!event.ctrlKey || !sized || !event.deltaY) return;
    event.preventDefault();
    this.app.actions.run(event.deltaY < 0 ? "brush.larger" : "brush.smaller");
    this.hover(this.pressOf(event));
  }

  private finish(at: Press): void {
    const gesture = this.gesture;
    this.gesture = null;
    gesture?.end(at);
  }

  private hover(at: Press | null): void {
    this.chosen?.hover?.(at);
    if (!at) {
      this.app.pointer.at = null;
      this.ends.hover(null);
    }
  }

  private key(event: KeyboardEvent): void {
    if (takesText(event.target)) return;
    const used = this.gesture?.key?.(event) ?? (!this.gesture && (this.chosen?.key?.(event) ?? false));
    if (this.gesture?.sticks && !used && event.key === "Enter") {
      this.finish({ ...(this.app.pointer.at ?? { x: 0, y: 0 }), ...NO_KEYS });
    } else if (!used) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  private pressOf(event: MouseEvent): Press {
    const box = this.app.canvas.getBoundingClientRect();
    const { shiftKey, ctrlKey, metaKey, altKey } = event;
    return { x: event.clientX - box.left, y: event.clientY - box.top, shiftKey, ctrlKey, metaKey, altKey };
  }
}

const NO_KEYS = { shiftKey: false, ctrlKey: false, metaKey: false, altKey: false };
