// What server and page say to each other. Commands are in commands.ts, made from Python.

export const PROTOCOL = 1;

export type Vec3 = [number, number, number];
/** [first, length] of flat C-order cell numbers: (x * Y + y) * Z + z. */
export type Run = [number, number];
/** [first, length, label, instance, confidence 0..255]: what cells hold now. */
export type HeldRun = [number, number, number, number, number];

export interface ClassInfo {
  id: number;
  name: string;
  colour: Vec3; // sRGB, 0..255
}

export interface Alternative {
  template: string;
  quarter_turns: number;
  iou: number;
}

/** The template of what is built from its own cells; it has no IoU. */
export const OWN_CELLS = "cells";

export interface Placed {
  template: string;
  center_m: Vec3;
  size_m: Vec3; // along its own axes: front-to-back, side, height
  quarter_turns: number;
  iou: number;
  parameters: Record<string, number>;
  alternatives: Alternative[];
}

export interface SceneObject {
  id: number;
  class_id: number;
  name: string; // of the vocabulary, a person's own, or empty
  name_confidence: number;
  title: string; // what people read: of the name, else of the class
  center_m: Vec3;
  size_m: Vec3; // along its own axes
  yaw_deg: number;
  confidence: number;
  cells: number; // how many
  placements: Placed[];
}

/** An answer to "warnings": furniture that collides, or extends beyond its room. */
export interface Clash {
  kind: "collision" | "outside";
  ids: number[];
}

/** GET /api/scene */
export interface Scene {
  protocol: number;
  document: number; // another one, another document
  name: string;
  rev: number;
  saved: boolean; // as it was saved, also after undo
  read_only: string; // why, empty where the scene may be edited
  notes: string[]; // for the person: what was recovered, what could not be written
  voxel_m: number;
  origin_m: Vec3;
  shape: Vec3;
  classes: ClassInfo[];
  counts: number[]; // of cells, by class id 0..11
  objects: SceneObject[];
  undo: string; // kind of what undo would take back, empty for nothing
  redo: string;
  is_demo: boolean;
  has: { photos: number; truth: boolean };
}

/** A change of the document: sent to every tab, in order. */
export interface Change {
  type: "change";
  rev: number;
  kind: string;
  counts_as: string;
  actor: string;
  step: "do" | "undo" | "redo";
  cells: HeldRun[] | null; // null: too many, get the volume again
  objects: SceneObject[]; // new or changed
  gone: number[]; // ids
  counts: number[];
  undo: string;
  redo: string;
  saved: boolean;
}

/**
 * The first message, and sent again where a tab slept too long to be told all changes, or another
 * document was opened: where document or rev is not what the tab has, it gets the scene again.
 */
export interface Hello {
  type: "hello";
  protocol: number;
  rev: number;
  document: number; // 0: none is open
}

export interface Saved {
  type: "saved";
  rev: number;
}

/** Answers to what this tab asked, by the number it gave. */
export interface Done {
  type: "done";
  seq: number;
  rev: number;
}

export interface Refused {
  type: "refused";
  seq: number;
  error: string; // one line for the user
}

export interface JobState {
  type: "job";
  id: string;
  title: string;
  stage: string;
  done: number;
  total: number; // 0: unknown
  share?: number | null; // of the whole job, 0 .. 1
  left_s: number | null;
  note: string;
  state: "running" | "done" | "failed" | "cancelled";
  result: unknown;
}

export type ServerMessage = Hello | Change | Saved | Done | Refused | JobState;

export type ClientMessage =
  | { type: "do"; seq: number; command: { op: string } & Record<string, unknown> }
  | { type: "undo"; seq: number }
  | { type: "redo"; seq: number }
  | { type: "save"; seq: number }
  | { type: "active" } // the person did something: effort is measured without idling
  | { type: "cancel"; job: string };
