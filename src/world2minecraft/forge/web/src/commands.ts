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

/** How many cells each class has, and how many objects there are. */
export type CountsQuery = Record<string, never>;

export type Command = SetCells | FillBox | DeleteComponent | Paste | RelabelClass | DeleteClass;

/** What each query is asked with. */
export interface Queries {
  counts: CountsQuery;
}
