// Made from the commands of edit/scene and the queries of forge by
// `python -m world2minecraft.forge.typescript`; do not edit.

/** Give cells one class; 0 erases them. */
export interface SetCells {
  locked?: number[];
  op: "set_cells";
  cells: [number, number][];
  /** >= 0, <= 11 */
  class_id: number;
  instance?: number | null;
  verb?: "paint" | "erase" | "relabel" | "fill" | "delete";
}

/** Give all cells of a box one class; 0 erases them. Both corners are in the box. */
export interface FillBox {
  locked?: number[];
  op: "fill_box";
  low: [number, number, number];
  high: [number, number, number];
  /** >= 0, <= 11 */
  class_id: number;
}

/** Erase a cell and all of its class that hold to it by faces. */
export interface DeleteComponent {
  locked?: number[];
  op: "delete_component";
  cell: [number, number, number];
}

/** Copy what cells hold to ``by`` cells farther, mirrored first where ``mirror`` names an axis. */
export interface Paste {
  locked?: number[];
  op: "paste";
  cells: [number, number][];
  by: [number, number, number];
  mirror?: "x" | "y" | "z" | null;
}

/** Give all cells and all objects of one class another. */
export interface RelabelClass {
  locked?: number[];
  op: "relabel_class";
  /** >= 1, <= 11 */
  from_id: number;
  /** >= 1, <= 11 */
  to_id: number;
}

/** Erase all cells and all objects of a class. */
export interface DeleteClass {
  locked?: number[];
  op: "delete_class";
  /** >= 1, <= 11 */
  class_id: number;
}

/** Put a piece of furniture of its usual size at a place, on what is under it there. */
export interface AddObject {
  op: "add_object";
  /** >= 5, <= 11 */
  class_id: number;
  at_m: [number, number, number];
  template?: string | null;
  quarter_turns?: number | null;
}

/** Remove objects: their cells are empty then; floor and walls behind them stay. */
export interface DeleteObjects {
  op: "delete_objects";
  ids: number[];
}

/** Put the same object again, centred at ``to_m``, or else beside itself where most is free. */
export interface DuplicateObject {
  op: "duplicate_object";
  /** >= 1, <= 65535 */
  id: number;
  to_m?: [number, number, number] | null;
}

/** Move an object, with its cells and its furniture, by whole cells to a new centre. */
export interface MoveObject {
  op: "move_object";
  /** >= 1, <= 65535 */
  id: number;
  to_m: [number, number, number];
}

/** Match the furniture of objects anew, as the reconstruction does, from their cells. */
export interface Rematch {
  op: "rematch";
  ids: number[];
}

/** Choose the furniture that stands for an object, fitted to its cells. */
export interface SetTemplate {
  op: "set_template";
  /** >= 1, <= 65535 */
  id: number;
  template: string;
  quarter_turns?: number | null;
}

/** Turn objects by quarters about their centres, counter-clockwise from above. */
export interface TurnObjects {
  op: "turn_objects";
  ids: number[];
  /** >= -3, <= 3 */
  quarter_turns: number;
}

/** How many cells each class has, and how many objects there are. */
export type CountsQuery = Record<string, never>;

export type Command =
  | SetCells
  | FillBox
  | DeleteComponent
  | Paste
  | RelabelClass
  | DeleteClass
  | AddObject
  | DeleteObjects
  | DuplicateObject
  | MoveObject
  | Rematch
  | SetTemplate
  | TurnObjects;

/** What each query is asked with. */
export interface Queries {
  counts: CountsQuery;
}
