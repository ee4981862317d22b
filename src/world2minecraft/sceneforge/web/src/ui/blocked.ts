// Why the document cannot be changed now: said by every control that would change it.

import type { Store } from "../store";
import { TEXT } from "../text";

export function cannotEdit(store: Store): string {
  const { scene, online } = store.get();
  if (!scene) return TEXT.why.noScene;
  if (!online) return TEXT.why.offline;
  return scene.read_only && TEXT.why.readOnly(scene.read_only);
}
