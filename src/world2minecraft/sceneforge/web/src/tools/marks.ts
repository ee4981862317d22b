// Lines over the scene in screen space: rubber bands, lassos, measured distances.

const SPACE = "http://www.w3.org/2000/svg";

export type Point = readonly [number, number];

export class Marks {
  private svg = document.createElementNS(SPACE, "svg");
  private parts = new Map<string, SVGElement>();

  constructor(host: HTMLElement) {
    this.svg.setAttribute("class", "marks");
    this.svg.setAttribute("aria-hidden", "true");
    host.append(this.svg);
  }

  polygon(name: string, points: readonly Point[], closed = true): void {
    const node = this.part(name, closed ? "polygon" : "polyline");
    node.setAttribute("points", points.map(([x, y]) => `${x},${y}`).join(" "));
  }

  /** A line with a word beside its middle. */
  ruler(name: string, from: Point, to: Point, words: string): void {
    const node = this.part(name, "g");
    node.replaceChildren();
    const ends = [from, to].map(([x, y]) => shape("circle", { cx: x, cy: y, r: 4 }));
    const [x, y] = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
    const text = shape("text", { x, y: y - 10, "text-anchor": "middle" });
    text.textContent = words;
    node.append(shape("line", { x1: from[0], y1: from[1], x2: to[0], y2: to[1] }), ...ends, text);
  }

  circle(name: string, at: Point, radius: number): void {
    const node = this.part(name, "circle");
    node.setAttribute("cx", String(at[0]));
    node.setAttribute("cy", String(at[1]));
    node.setAttribute("r", String(radius));
  }

  clear(name: string): void {
    this.parts.get(name)?.remove();
    this.parts.delete(name);
  }

  private part(name: string, kind: string): SVGElement {
    const old = this.parts.get(name);
    if (old?.localName === kind) return old;
    old?.remove();
    const node = shape(kind, {});
    node.setAttribute("data-mark", name);
    this.svg.append(node);
    this.parts.set(name, node);
    return node;
  }
}

function shape(kind: string, attributes: Record<string, string | number>): SVGElement {
  const node = document.createElementNS(SPACE, kind);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, String(value));
  return node as SVGElement;
}
