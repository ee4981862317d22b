// Made from core.classes, core.vocabulary, the commands of editing.scene and the queries of
// sceneforge by `python -m world2minecraft.sceneforge.typescript`; do not edit.

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

/** The names of objects, with their synonyms. */
export const THING_NAMES: readonly { name: string; title: string; class_id: number; labels: readonly string[] }[] = [
  {"name": "ceiling", "title": "ceiling", "class_id": 1, "labels": ["ceiling tile"]},
  {"name": "floor", "title": "floor", "class_id": 2, "labels": ["floor wood", "floor tile", "floor marble", "floor stone", "flooring"]},
  {"name": "wall", "title": "wall", "class_id": 3, "labels": ["wall brick", "wall stone", "wall tile", "wall wood", "wall panel", "wall concrete"]},
  {"name": "window", "title": "window", "class_id": 4, "labels": ["windowpane"]},
  {"name": "rug", "title": "rug", "class_id": 2, "labels": ["carpet", "mat", "floor mat", "doormat"]},
  {"name": "chair", "title": "chair", "class_id": 5, "labels": ["seat", "folding chair", "dining chair"]},
  {"name": "armchair", "title": "armchair", "class_id": 5, "labels": ["recliner", "easy chair", "club chair"]},
  {"name": "office chair", "title": "office chair", "class_id": 5, "labels": ["swivel chair", "desk chair"]},
  {"name": "beanbag", "title": "beanbag", "class_id": 5, "labels": ["bean bag"]},
  {"name": "stool", "title": "stool", "class_id": 5, "labels": ["footstool"]},
  {"name": "bar stool", "title": "bar stool", "class_id": 5, "labels": ["barstool", "high stool"]},
  {"name": "bench", "title": "bench", "class_id": 5, "labels": ["window seat"]},
  {"name": "ottoman", "title": "ottoman", "class_id": 5, "labels": ["pouf", "pouffe", "hassock"]},
  {"name": "sofa", "title": "sofa", "class_id": 7, "labels": ["couch", "settee", "loveseat", "sofa bed", "studio couch"]},
  {"name": "corner sofa", "title": "corner sofa", "class_id": 7, "labels": ["sectional", "sectional sofa", "l shaped sofa"]},
  {"name": "bed", "title": "bed", "class_id": 6, "labels": ["infant bed"]},
  {"name": "single bed", "title": "single bed", "class_id": 6, "labels": ["twin bed", "daybed"]},
  {"name": "bunk bed", "title": "bunk bed", "class_id": 6, "labels": ["loft bed"]},
  {"name": "crib", "title": "crib", "class_id": 6, "labels": ["cradle", "cot"]},
  {"name": "table", "title": "table", "class_id": 8, "labels": ["dining table", "kitchen table", "play table", "kitchen & dining room table"]},
  {"name": "round table", "title": "round table", "class_id": 8, "labels": []},
  {"name": "bar table", "title": "bar table", "class_id": 8, "labels": ["high table", "bistro table"]},
  {"name": "coffee table", "title": "coffee table", "class_id": 8, "labels": ["low table", "cocktail table"]},
  {"name": "side table", "title": "side table", "class_id": 8, "labels": ["end table", "occasional table"]},
  {"name": "console table", "title": "console table", "class_id": 8, "labels": ["sofa table", "hall table"]},
  {"name": "desk", "title": "desk", "class_id": 8, "labels": ["writing desk", "computer desk"]},
  {"name": "picnic table", "title": "picnic table", "class_id": 8, "labels": []},
  {"name": "pool table", "title": "pool table", "class_id": 8, "labels": ["billiard table", "snooker table"]},
  {"name": "table tennis table", "title": "table tennis table", "class_id": 8, "labels": ["ping pong table"]},
  {"name": "cabinet", "title": "cabinet", "class_id": 10, "labels": ["cupboard", "case", "storage", "filing cabinet", "locker", "bathroom cabinet", "bath cabinet", "cabinetry"]},
  {"name": "wall cabinet", "title": "wall cabinet", "class_id": 10, "labels": ["upper cabinet", "hanging cabinet"]},
  {"name": "display cabinet", "title": "display cabinet", "class_id": 10, "labels": ["vitrine", "glass cabinet", "china cabinet"]},
  {"name": "wardrobe", "title": "wardrobe", "class_id": 10, "labels": ["closet", "armoire"]},
  {"name": "chest of drawers", "title": "chest of drawers", "class_id": 10, "labels": ["dresser", "drawer", "bureau", "commode", "tallboy"]},
  {"name": "sideboard", "title": "sideboard", "class_id": 10, "labels": ["buffet", "credenza"]},
  {"name": "tv stand", "title": "tv stand", "class_id": 10, "labels": ["tv board", "tv cabinet", "media console", "entertainment center"]},
  {"name": "nightstand", "title": "nightstand", "class_id": 10, "labels": ["night stand", "bedside table", "bedside cabinet"]},
  {"name": "blanket chest", "title": "blanket chest", "class_id": 10, "labels": ["trunk", "chest"]},
  {"name": "bookcase", "title": "bookcase", "class_id": 10, "labels": ["bookshelf"]},
  {"name": "shelf", "title": "shelf", "class_id": 10, "labels": ["shelves", "shelving", "rack", "shelf unit", "spiral shelf", "toy shelf"]},
  {"name": "wall shelf", "title": "wall shelf", "class_id": 10, "labels": ["floating shelf"]},
  {"name": "shoe rack", "title": "shoe rack", "class_id": 10, "labels": ["shoe cabinet"]},
  {"name": "furniture", "title": "piece of furniture", "class_id": 10, "labels": ["otherfurniture", "other furniture"]},
  {"name": "counter", "title": "counter", "class_id": 10, "labels": ["countertop", "bar", "worktop", "kitchen counter", "base cabinet"]},
  {"name": "kitchen island", "title": "kitchen island", "class_id": 10, "labels": ["island"]},
  {"name": "sink", "title": "sink", "class_id": 10, "labels": ["kitchen sink", "sink unit", "sink counter"]},
  {"name": "oven", "title": "oven", "class_id": 10, "labels": ["wall oven", "built in oven"]},
  {"name": "stove", "title": "stove", "class_id": 10, "labels": ["cooker", "range", "hob", "gas stove", "cooktop"]},
  {"name": "range hood", "title": "range hood", "class_id": 11, "labels": ["hood", "extractor hood", "cooker hood"]},
  {"name": "refrigerator", "title": "refrigerator", "class_id": 10, "labels": ["fridge", "freezer"]},
  {"name": "dishwasher", "title": "dishwasher", "class_id": 10, "labels": []},
  {"name": "washing machine", "title": "washing machine", "class_id": 10, "labels": ["washer", "washer dryer", "clothes dryer", "dryer", "tumble dryer"]},
  {"name": "microwave", "title": "microwave", "class_id": 11, "labels": ["microwave oven", "toaster", "toaster oven"]},
  {"name": "toilet", "title": "toilet", "class_id": 11, "labels": ["water closet", "wc", "bidet"]},
  {"name": "washbasin", "title": "washbasin", "class_id": 10, "labels": ["basin", "bathroom sink", "pedestal sink", "vanity", "washstand"]},
  {"name": "bathtub", "title": "bathtub", "class_id": 10, "labels": ["bath", "tub", "jacuzzi"]},
  {"name": "shower", "title": "shower", "class_id": 11, "labels": ["shower cabin", "shower stall"]},
  {"name": "shower curtain", "title": "shower curtain", "class_id": 11, "labels": []},
  {"name": "towel", "title": "towel", "class_id": 11, "labels": ["bath towel"]},
  {"name": "laundry basket", "title": "laundry basket", "class_id": 11, "labels": ["basket", "hamper", "laundry hamper"]},
  {"name": "drying rack", "title": "drying rack", "class_id": 11, "labels": ["clothes horse", "clothes airer", "airer"]},
  {"name": "ironing board", "title": "ironing board", "class_id": 11, "labels": ["iron"]},
  {"name": "television", "title": "screen", "class_id": 9, "labels": ["tv", "television receiver", "crt screen", "screen"]},
  {"name": "monitor", "title": "monitor", "class_id": 9, "labels": ["computer", "computer monitor", "computer screen", "display"]},
  {"name": "projector screen", "title": "projector screen", "class_id": 9, "labels": ["projection screen"]},
  {"name": "door", "title": "door", "class_id": 11, "labels": ["double door", "screen door", "door handle"]},
  {"name": "curtain", "title": "curtain", "class_id": 11, "labels": ["drape", "drapery", "drapes"]},
  {"name": "blind", "title": "blind", "class_id": 11, "labels": ["blinds", "window blind", "roller blind", "venetian blind", "shade"]},
  {"name": "picture", "title": "picture", "class_id": 11, "labels": ["painting", "poster", "picture frame", "portrait", "photo"]},
  {"name": "mirror", "title": "mirror", "class_id": 11, "labels": []},
  {"name": "whiteboard", "title": "whiteboard", "class_id": 11, "labels": ["bulletin board", "blackboard", "notice board"]},
  {"name": "clock", "title": "clock", "class_id": 11, "labels": ["wall clock", "alarm clock"]},
  {"name": "grandfather clock", "title": "grandfather clock", "class_id": 10, "labels": ["longcase clock"]},
  {"name": "radiator", "title": "radiator", "class_id": 11, "labels": ["heater", "heating"]},
  {"name": "towel radiator", "title": "towel radiator", "class_id": 11, "labels": ["towel rail", "heated towel rail"]},
  {"name": "fireplace", "title": "fireplace", "class_id": 10, "labels": ["hearth"]},
  {"name": "lamp", "title": "lamp", "class_id": 11, "labels": ["floor lamp", "standing lamp", "arc lamp"]},
  {"name": "table lamp", "title": "table lamp", "class_id": 11, "labels": ["desk lamp", "bedside lamp"]},
  {"name": "ceiling lamp", "title": "ceiling lamp", "class_id": 11, "labels": ["light", "ceiling light", "light fixture"]},
  {"name": "pendant lamp", "title": "pendant lamp", "class_id": 11, "labels": ["pendant", "hanging lamp", "pendant light"]},
  {"name": "chandelier", "title": "chandelier", "class_id": 11, "labels": []},
  {"name": "wall lamp", "title": "wall lamp", "class_id": 11, "labels": ["sconce", "wall light"]},
  {"name": "candle", "title": "candle", "class_id": 11, "labels": ["candles", "candlestick"]},
  {"name": "plant", "title": "plant", "class_id": 11, "labels": ["potted plant", "houseplant", "flowerpot"]},
  {"name": "indoor tree", "title": "indoor tree", "class_id": 11, "labels": ["potted tree"]},
  {"name": "flowers", "title": "flowers", "class_id": 11, "labels": ["flower", "bouquet"]},
  {"name": "cactus", "title": "cactus", "class_id": 11, "labels": []},
  {"name": "hanging plant", "title": "hanging plant", "class_id": 11, "labels": []},
  {"name": "planter", "title": "planter", "class_id": 11, "labels": ["planter box", "plant box"]},
  {"name": "christmas tree", "title": "christmas tree", "class_id": 11, "labels": ["fir tree"]},
  {"name": "piano", "title": "piano", "class_id": 10, "labels": ["upright piano"]},
  {"name": "grand piano", "title": "grand piano", "class_id": 10, "labels": []},
  {"name": "aquarium", "title": "aquarium", "class_id": 11, "labels": ["fish tank", "tank"]},
  {"name": "bicycle", "title": "bicycle", "class_id": 11, "labels": ["bike"]},
  {"name": "toy", "title": "toy", "class_id": 11, "labels": ["plaything", "teddy", "teddy bear", "doll", "bricks", "rocking horse", "arcade machine"]},
  {"name": "ball", "title": "ball", "class_id": 11, "labels": ["sports ball", "gym ball"]},
  {"name": "guitar", "title": "guitar", "class_id": 11, "labels": ["musical instrument"]},
  {"name": "easel", "title": "easel", "class_id": 11, "labels": []},
  {"name": "cat tree", "title": "cat tree", "class_id": 11, "labels": ["scratching post"]},
  {"name": "box", "title": "box", "class_id": 11, "labels": ["cardboard", "carton", "barrel", "cardboard box"]},
  {"name": "crate", "title": "crate", "class_id": 11, "labels": ["wooden crate"]},
  {"name": "bag", "title": "bag", "class_id": 11, "labels": ["backpack", "handbag", "suitcase", "luggage"]},
  {"name": "waste bin", "title": "waste bin", "class_id": 11, "labels": ["ashcan", "trash can", "garbage bin", "waste container", "trash bin", "pedal bin", "bin"]},
  {"name": "coat stand", "title": "coat stand", "class_id": 11, "labels": ["coat rack", "hat stand"]},
  {"name": "umbrella stand", "title": "umbrella stand", "class_id": 11, "labels": []},
  {"name": "vase", "title": "vase", "class_id": 11, "labels": ["pot", "urn", "floor vase"]},
  {"name": "sculpture", "title": "sculpture", "class_id": 11, "labels": ["bust", "statue"]},
  {"name": "cushion", "title": "cushion", "class_id": 11, "labels": ["pillow"]},
  {"name": "blanket", "title": "blanket", "class_id": 11, "labels": ["quilt", "bedspread", "duvet"]},
  {"name": "books", "title": "books", "class_id": 11, "labels": ["book", "magazine"]},
  {"name": "paper", "title": "paper", "class_id": 11, "labels": ["document", "newspaper"]},
  {"name": "clothes", "title": "clothes", "class_id": 11, "labels": ["apparel", "clothing", "laundry", "coat", "coats", "tie", "umbrella", "hat"]},
  {"name": "shoes", "title": "shoes", "class_id": 11, "labels": ["shoe", "boots", "slippers"]},
  {"name": "laptop", "title": "laptop", "class_id": 11, "labels": ["notebook computer"]},
  {"name": "printer", "title": "printer", "class_id": 11, "labels": ["copier", "scanner"]},
  {"name": "keyboard", "title": "keyboard", "class_id": 11, "labels": ["computer keyboard", "mouse", "remote", "cell phone"]},
  {"name": "tableware", "title": "tableware", "class_id": 11, "labels": ["plate", "bottle", "glass", "wine glass", "cup", "fork", "knife", "spoon", "bowl", "tray", "kettle"]},
  {"name": "food", "title": "food", "class_id": 11, "labels": ["fruit", "banana", "apple", "sandwich", "orange", "broccoli", "carrot", "hot dog", "pizza", "donut", "cake"]},
  {"name": "fan", "title": "fan", "class_id": 11, "labels": ["ceiling fan", "ventilator"]},
  {"name": "person", "title": "person", "class_id": 11, "labels": ["man", "woman", "people"]},
  {"name": "animal", "title": "animal", "class_id": 11, "labels": ["cat", "dog"]},
  {"name": "stairs", "title": "stairs", "class_id": 11, "labels": ["stairway", "step", "case of stairs", "staircase", "escalator"]},
  {"name": "railing", "title": "railing", "class_id": 11, "labels": ["bannister", "banister", "handrail"]},
  {"name": "column", "title": "column", "class_id": 11, "labels": ["pole", "pillar", "other structure", "otherstructure"]},
  {"name": "object", "title": "object", "class_id": 11, "labels": ["otherprop", "other prop", "base", "signboard", "booth", "stage", "canopy", "flag", "trade name", "conveyer belt", "banner", "net", "platform", "skateboard", "tennis racket", "scissors", "hair drier", "toothbrush", "baseball bat", "baseball glove", "frisbee", "skis", "snowboard", "surfboard", "kite"]},
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

/** Merge objects into one with the id, class and name of the first object listed. */
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

/** Name objects, such as ``piano``. An empty name restores the display name of the class. */
export interface RenameObjects {
  op: "rename_objects";
  ids: number[];
  name: string;
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
  | RenameObjects
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
