// What differs between the scene and another occupancy on the same cells, and the IoU of both.
// The other one counts as the truth; its unknown cells are left out. As metrics/occupancy.py.

import type { Run } from "../wire";

export interface Compared {
  added: Run[];
  removed: Run[];
  changed: Run[];
  cells: { added: number; removed: number; changed: number };
  iou: number;
  miou: number; // over the classes that the truth holds
}

const UNKNOWN = 255;
const CLASSES = 12;

/** `beyond` is how many cells of each class the other one has where the scene has no cells. */
export function compare(now: Uint8Array, other: Uint8Array, beyond: readonly number[] = []): Compared {
  const table = new Float64Array(CLASSES * CLASSES); // [truth, now]
  beyond.forEach((cells, truth) => (table[truth * CLASSES]! += cells));
  const runs = { added: [] as Run[], removed: [] as Run[], changed: [] as Run[] };
  let open: { run: Run; kind: keyof typeof runs } | null = null;
  for (let flat = 0; flat < other.length; flat++) {
    const truth = other[flat]!;
    const held = now[flat] === UNKNOWN ? 0 : now[flat]!;
    if (truth !== UNKNOWN) table[truth * CLASSES + held]! += 1;
    const kind = truth === UNKNOWN || truth === held ? null : truth === 0 ? "added" : held === 0 ? "removed" : "changed";
    if (open && kind === open.kind) open.run[1] += 1;
    else if (kind) runs[kind].push((open = { run: [flat, 1], kind }).run);
    else open = null;
  }
  const count = (kind: keyof typeof runs): number => runs[kind].reduce((sum, run) => sum + run[1], 0);
  const cells = { added: count("added"), removed: count("removed"), changed: count("changed") };
  return { ...runs, cells, ...scores(table) };
}

function scores(table: Float64Array): { iou: number; miou: number } {
  const at = (truth: number, held: number): number => table[truth * CLASSES + held]!;
  let both = 0;
  let either = 0;
  const ious: number[] = [];
  for (let truth = 0; truth < CLASSES; truth++) {
    let inTruth = 0;
    let inNow = 0;
    for (let held = 0; held < CLASSES; held++) {
      inTruth += at(truth, held);
      inNow += at(held, truth);
      if (truth && held) both += at(truth, held);
      if (truth || held) either += at(truth, held);
    }
    if (truth && inTruth) ious.push(at(truth, truth) / (inTruth + inNow - at(truth, truth)));
  }
  const mean = ious.length ? ious.reduce((sum, one) => sum + one, 0) / ious.length : 0;
  return { iou: either ? both / either : 0, miou: mean };
}
