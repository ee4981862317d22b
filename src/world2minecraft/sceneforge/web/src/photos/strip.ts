// The strip of photos below the scene: a click stands one where the photo was taken.

import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { check, plainButton, segment, slider } from "../ui/fields";
import { rove } from "../ui/rove";
import { registerPanel, type App } from "../ui/slots";
import { getJson, said } from "../start/api";
import type { Frame } from "./place";
import { PhotoViewer, WAYS, type Way } from "./viewer";

export function registerPhotos(): void {
  registerPanel({
    id: "photos",
    title: TEXT.photos.title,
    place: "drawer",
    modes: ["inspect", "voxels", "objects", "build"],
    order: 10,
    mount: (host, app) => new Strip(host, app),
  });
}

class Strip {
  private frames: Frame[] = [];
  private loaded = "";
  private readonly list = h("div", { class: "photo-list", role: "toolbar", "aria-label": TEXT.photos.title });
  private readonly note = h("p", { class: "note" });
  private readonly tools = h("div", { class: "photo-tools" });
  private readonly viewer: PhotoViewer;

  constructor(
    host: HTMLElement,
    private readonly app: App,
  ) {
    this.viewer = new PhotoViewer(app, () => this.show());
    host.append(h("div", { class: "photo-strip" }, this.tools, this.list));
    this.makeTools();
    new IntersectionObserver((seen) => {
      if (seen.some((one) => one.isIntersecting)) void this.load();
    }).observe(host);
    const why = (): string => (this.viewer.frame ? "" : TEXT.photos.why);
    app.actions.on("photo.way", { run: () => this.viewer.next(), why });
    app.actions.on("photo.leave", { run: () => this.viewer.leave(), why });
  }

  private async load(): Promise<void> {
    const name = this.app.store.get().scene?.name ?? "";
    if (!name || this.loaded === name) return;
    this.loaded = name;
    fill(this.note, TEXT.photos.loading);
    try {
      const told = await getJson<{ frames: Frame[]; why: string }>("api/photos");
      this.frames = told.frames;
      fill(this.note, told.why || TEXT.photos.count(told.frames.length));
    } catch (error) {
      this.loaded = "";
      fill(this.note, said(error));
    }
    fill(this.list, ...this.frames.map((frame) => this.thumb(frame)));
    rove(this.list);
    this.show();
  }

  private thumb(frame: Frame): HTMLElement {
    const title = TEXT.photos.fly(frame.name);
    const picture = h("img", { src: `api/photos/${frame.n}/small.jpg`, alt: title, loading: "lazy" });
    const node = h("button", { type: "button", class: "photo", title, data: { photo: String(frame.n) } }, picture);
    node.addEventListener("click", () => this.viewer.open(frame));
    return node;
  }

  private makeTools(): void {
    const words = TEXT.photos;
    const ways = segment<Way>(
      words.title,
      () => WAYS.map((value) => ({ value, label: words.ways[value] ?? value })),
      (way) => this.viewer.set(way),
    );
    const blend = slider({
      label: words.blend,
      min: 0,
      max: 1,
      step: 0.05,
      show: (share) => TEXT.percent(share),
      change: (share) => this.viewer.set("blend", share),
      id: "photo-blend",
    });
    const cameras = check(words.cameras, "photo-cameras", (on) => this.viewer.cameras(this.frames, on));
    const classes = check(words.classes, "photo-classes", (on) => this.viewer.showClasses(on));
    const leave = plainButton(words.leave, () => this.viewer.leave());
    this.showTools = () => {
      const { frame, way } = this.viewer;
      ways.node.hidden = classes.node.hidden = leave.hidden = !frame;
      blend.node.hidden = !frame || way !== "blend";
      ways.set(way);
      blend.set(this.viewer.blend);
    };
    this.tools.append(this.note, cameras.node, ways.node, blend.node, classes.node, leave);
    this.showTools();
  }

  private showTools: () => void = () => undefined;

  private show(): void {
    this.showTools();
    const chosen = this.viewer.frame?.n;
    for (const node of this.list.querySelectorAll<HTMLElement>("[data-photo]")) {
      const on = node.dataset.photo === String(chosen);
      node.setAttribute("aria-pressed", String(on));
      if (on) node.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
  }
}
