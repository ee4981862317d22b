// Made from core.classes, the commands of editing.scene and the queries of sceneforge by
// `python -m world2minecraft.sceneforge.typescript`; do not edit.

/** Display name of each class, by id. */
export const CLASS_DISPLAY_NAMES: readonly string[] = [
  "empty",
  "ceiling",
  "floor",
  "wall",
  "window",
  "chair",
  "bed",
  "sofa",
  "table",
  "television",
  "furniture",
  "object",
];

/** Set the class of cells. Class 0 erases them. */
export interface SetCells {
  locked?: number[];
  op: "set_cells";
  cells: [number, number][];
  /** >= 0, <= 11 */
  class_id: number;
  instance?: number | null;
  verb?: "paint" | "erase" | "relabel" | "fill" | "delete";
}

/** Set the class of all cells in a box with inclusive corners. Class 0 erases them. */
export interface FillBox {
  locked?: number[];
  op: "fill_box";
  low: [number, number, number];
  high: [number, number, number];
  /** >= 0, <= 11 */
  class_id: number;
}

/** Erase a cell and all cells of its class that are connected to it by faces. */
export interface DeleteComponent {
  locked?: number[];
  op: "delete_component";
  cell: [number, number, number];
}

/** Copy cells to a position ``by`` cells away, mirrored first if ``mirror`` names an axis. */
export interface Paste {
  locked?: number[];
  op: "paste";
  cells: [number, number][];
  by: [number, number, number];
  mirror?: "x" | "y" | "z" | null;
}

/** Change the class of all cells and objects of one class. */
export interface RelabelClass {
  locked?: number[];
  op: "relabel_class";
  /** >= 1, <= 11 */
  from_id: number;
  /** >= 1, <= 11 */
  to_id: number;
}

/** Erase all cells and delete all objects of a class. */
export interface DeleteClass {
  locked?: number[];
  op: "delete_class";
  /** >= 1, <= 11 */
  class_id: number;
}

/** Erase all unconnected pieces with at most ``max_cells`` cells. */
export interface RemoveFloaters {
  locked?: number[];
  op: "remove_floaters";
  /** >= 1 */
  max_cells?: number;
  keep?: number[];
}

/** Fill the holes of a plane, of an object's surface, or of all planes. */
export interface FillHoles {
  locked?: number[];
  op: "fill_holes";
  plane: string;
  cell?: [number, number, number] | null;
  /** >= 0 */
  hole_m2?: number;
}

/** Smooth furniture with a majority filter, without moving structure. */
export interface Smooth {
  locked?: number[];
  op: "smooth";
  class_id?: number | null;
  runs?: [number, number][] | null;
}

/** Add a piece of furniture of typical size at a position, on top of what is below. */
export interface AddObject {
  op: "add_object";
  /** >= 5, <= 11 */
  class_id: number;
  at_m: [number, number, number];
  template?: string | null;
  quarter_turns?: number | null;
}

/** Delete objects and empty their cells, keeping the floor and walls behind them. */
export interface DeleteObjects {
  op: "delete_objects";
  ids: number[];
}

/** Duplicate an object, centred at ``to_m``, or next to the original where most space is free. */
export interface DuplicateObject {
  op: "duplicate_object";
  /** >= 1, <= 65535 */
  id: number;
  to_m?: [number, number, number] | null;
}

/** Merge objects into one with the id and the class of the first object in the list. */
export interface MergeObjects {
  op: "merge_objects";
  ids: number[];
}

/** Move an object with its cells and furniture by whole cells to a new centre. */
export interface MoveObject {
  op: "move_object";
  /** >= 1, <= 65535 */
  id: number;
  to_m: [number, number, number];
}

/** Detect the objects of one or all classes again with other clustering parameters. */
export interface Recluster {
  op: "recluster";
  class_id?: number | null;
  /** >= 1, <= 31 */
  density_kernel: number;
  /** >= 0, <= 1 */
  density_threshold: number;
  /** > 0, <= 100 */
  cluster_radius: number;
}

/** Change the class of objects and their cells, and match furniture of that class. */
export interface RelabelObjects {
  op: "relabel_objects";
  ids: number[];
  /** >= 5, <= 11 */
  class_id: number;
}

/** Match the furniture of objects again from their cells, as in the reconstruction. */
export interface Rematch {
  op: "rematch";
  ids: number[];
}

/** Choose the furniture template of an object, fitted to the object's cells. */
export interface SetTemplate {
  op: "set_template";
  /** >= 1, <= 65535 */
  id: number;
  template: string;
  quarter_turns?: number | null;
}

/** Move an object vertically onto the surface below it, or sideways to the nearest wall. */
export interface SnapObject {
  op: "snap_object";
  /** >= 1, <= 65535 */
  id: number;
  to: "floor" | "wall";
}

/** Split an object into several parts by the positions of its cells, or in two by a plane. */
export interface SplitObject {
  op: "split_object";
  /** >= 1, <= 65535 */
  id: number;
  parts?: number | null;
  plane?: CutPlane | null;
}

/** Split each of several objects into a number of parts by the positions of its cells. */
export interface SplitObjects {
  op: "split_objects";
  ids: number[];
  /** >= 2, <= 8 */
  parts?: number;
}

/** Rotate objects by quarter turns about their centres, counter-clockwise from above. */
export interface TurnObjects {
  op: "turn_objects";
  ids: number[];
  /** >= -3, <= 3 */
  quarter_turns: number;
}

/** The number of cells of each class, and the number of objects. */
export type CountsQuery = Record<string, never>;

/** Unsupported pieces of at most ``max_cells`` cells, largest first. */
export interface FloatersQuery {
  /** >= 1 */
  max_cells?: number;
}

/** The planes of the room (floors, ceilings and walls) with their holes and openings. */
export interface HolesQuery {
  /** >= 0 */
  hole_m2?: number;
}

/** The differences between the scene and another occupancy of the same room, with the IoU. */
export interface CompareQuery {
  path?: string;
}

/** The five best furniture templates for an object, each at its best rotation, with IoU. */
export interface AlternativesQuery {
  /** >= 1, <= 65535 */
  id: number;
}

/** The object centres that given clustering parameters yield, as a preview without changes. */
export interface CentersQuery {
  /** >= 1, <= 31 */
  density_kernel: number;
  /** >= 0, <= 1 */
  density_threshold: number;
  /** > 0, <= 100 */
  cluster_radius: number;
  class_id?: number | null;
}

/** Places that may need correction, most doubtful first, each with the reason in ``why``. */
export type DoubtfulQuery = Record<string, never>;

/** Furniture that collides or extends beyond its room, by the metrics of the report. */
export type WarningsQuery = Record<string, never>;

/** A plane perpendicular to an axis of the room, such as x = 1.4 m. */
export interface CutPlane {
  axis: "x" | "y" | "z";
  /** >= -10000, <= 10000 */
  at_m: number;
}

export type Command =
  | SetCells
  | FillBox
  | DeleteComponent
  | Paste
  | RelabelClass
  | DeleteClass
  | RemoveFloaters
  | FillHoles
  | Smooth
  | AddObject
  | DeleteObjects
  | DuplicateObject
  | MergeObjects
  | MoveObject
  | Recluster
  | RelabelObjects
  | Rematch
  | SetTemplate
  | SnapObject
  | SplitObject
  | SplitObjects
  | TurnObjects;

/** The fields of each query. */
export interface Queries {
  counts: CountsQuery;
  floaters: FloatersQuery;
  holes: HolesQuery;
  compare: CompareQuery;
  alternatives: AlternativesQuery;
  centers: CentersQuery;
  doubtful: DoubtfulQuery;
  warnings: WarningsQuery;
}
