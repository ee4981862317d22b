// Stands in where no picture can be made.

import type { ViewLike } from "./view_like";

export function noView(): ViewLike {
  return {
    onFrame: [],
    controls: { claims: () => true, dragging: false },
    orbit: { target: [0, 0, 0], azimuth: 0, elevation: 0, distance: 1, ortho: false },
    pick: () => null,
    pointAt: () => null,
    project: () => null,
    toRoom: () => null,
    cellsInRect: () => [],
    cellsInLasso: () => [],
    setOverlay: () => undefined,
    frame: () => undefined,
    focus: () => undefined,
    lookAlong: () => undefined,
    invalidate: () => undefined,
    idle: () => Promise.resolve(),
  };
}
