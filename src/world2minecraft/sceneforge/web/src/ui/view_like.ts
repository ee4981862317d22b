// What the page draws with.

import type { SceneView } from "../view/view";

export type ViewLike = SceneView;
export type { Picked } from "../view/view";
