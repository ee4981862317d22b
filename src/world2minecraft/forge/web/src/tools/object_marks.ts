// Centres of objects and boxes around the selected ones, over the scene. Drawn in screen space:
// they are always seen, always sharp, and cost software GL nothing.

import type { App } from "../ui/slots";
import type { SceneObject, Vec3 } from "../wire";
import { isHidden } from "./objects_at";

const SPACE = "http://www.w3.org/2000/svg";
const LEAST_PX = 4;
const MOST_PX = 22;

type Point = [number, number];

export function showObjectMarks(app: App): void {
  const svg = document.createElementNS(SPACE, "svg");
  svg.setAttribute("class", "marks object-marks");
  svg.setAttribute("aria-hidden", "true");
  const boxes = document.createElementNS(SPACE, "path");
  boxes.setAttribute("class", "object-boxes");
  const dots = document.createElementNS(SPACE, "g");
  svg.append(boxes, dots);
  app.stage.insertBefore(svg, app.canvas.nextSibling);
  const draw = (): void => {
    const { objects, selectedObjects, mode } = app.store.get();
    const shown = mode === "walk" ? [] : [...selectedObjects].flatMap((id) => objects.get(id) ?? []);
    boxes.setAttribute("d", shown.map((one) => boxPath(app, one)).join(""));
    drawDots(app, dots);
  };
  app.view.onFrame.push(draw);
  app.store.watch(["objects", "selectedObjects", "mode", "view", "scene"], draw);
}

function drawDots({ store, view }: App, dots: SVGGElement): void {
  const { objects, selectedObjects, mode, scene, view: look } = store.get();
  const some = mode === "objects" && look.centerSize > 0 ? [...objects.values()] : [];
  const shown = some.filter((one) => !isHidden(one.class_id, look.hidden, look.solo));
  while (dots.children.length > shown.length) dots.lastElementChild?.remove();
  shown.forEach((one, at) => {
    const dot = dots.children[at] ?? dots.appendChild(document.createElementNS(SPACE, "circle"));
    const where = view.project(one.center_m);
    const aside = where && view.project(besides(one.center_m, look.centerSize / 2));
    dot.setAttribute("visibility", where ? "visible" : "hidden");
    if (!where || !aside) return;
    const radius = Math.hypot(aside[0] - where[0], aside[1] - where[1]);
    dot.setAttribute("cx", String(where[0]));
    dot.setAttribute("cy", String(where[1]));
    dot.setAttribute("r", String(Math.min(MOST_PX, Math.max(LEAST_PX, radius))));
    dot.setAttribute("fill", `rgb(${(scene?.classes[one.class_id]?.colour ?? [128, 128, 128]).join(",")})`);
    dot.setAttribute("data-object", String(one.id));
    dot.setAttribute("class", selectedObjects.has(one.id) ? "centre is-selected" : "centre");
  });
}

function besides([x, y, z]: Vec3, by: number): Vec3 {
  return [x, y, z + by];
}

/** The twelve edges of an object's box, turned as it is. */
function boxPath({ view }: App, { center_m, size_m, yaw_deg }: SceneObject): string {
  const turn = (yaw_deg * Math.PI) / 180;
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((at): Point | null => {
    const [u, v, w] = [0, 1, 2].map((axis) => ((at >> axis) % 2 ? 0.5 : -0.5) * (size_m[axis as 0] ?? 0)) as Vec3;
    return view.project([center_m[0] + u * cos - v * sin, center_m[1] + u * sin + v * cos, center_m[2] + w]);
  });
  let path = "";
  for (let from = 0; from < 8; from++) {
    for (const bit of [1, 2, 4]) {
      const [a, b] = [corners[from], corners[from | bit]];
      if (!(from & bit) && a && b) path += `M${a[0]},${a[1]}L${b[0]},${b[1]}`;
    }
  }
  return path;
}
