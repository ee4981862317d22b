// What a tool is: it is asked whether a press is its own, and gives a gesture that lasts until the
// button is let go. Esc cancels it; nothing of the document changes before its end.

import type { App } from "../ui/slots";
import type { Marks } from "./marks";
import type { Selection } from "./selection";

export interface Press {
  x: number; // CSS pixels from the canvas's upper left corner
  y: number;
  shiftKey: boolean;
  ctrlKey: boolean;
  metaKey: boolean;
  altKey: boolean;
}

export interface Gesture {
  move(at: Press): void;
  end(at: Press): void;
  cancel(): void;
  key?(event: KeyboardEvent): boolean; // whether it used the key
  sticks?: true; // goes on without a button until the next press or Enter
}

export interface Desk {
  app: App;
  selection: Selection;
  marks: Marks;
  begin(gesture: Gesture): void; // one that a key began
}

export interface Tool {
  id: string;
  cursor: string;
  claims?(at: Press): boolean; // whether a press of the left button here is its own; all, if left out
  press(at: Press): Gesture | null;
  hover?(at: Press | null): void;
  start?(): void; // chosen
  stop?(): void; // another is chosen
  key?(event: KeyboardEvent): boolean;
}
