// The screens of the phone page: what is on each, and what its buttons do.

import { timeOf } from "../jobs/progress";
import { fill, h, type Child } from "../ui/dom";
import { icon, type IconName } from "../ui/icons";
import type { JobState } from "../wire";
import { bytesOf, type Picks } from "./picks";
import { TEXT } from "./text";
import { CAPTURES, type CaptureTold } from "./told";

const GOOD_PHOTOS = 30;
const MOST_THUMBS = 11; // and a twelfth tile for how many more
const THUMB_PX = 240;

export type Step = 0 | 1 | 2;

/** A screen: its step, its words, and below them the buttons, within reach of a thumb. */
export function screen(step: Step | null, title: string, body: Child[], buttons: Child[]): HTMLElement {
  return h(
    "section",
    { class: "screen" },
    step !== null && stepsLine(step),
    h("h1", { tabindex: -1 }, title),
    h("div", { class: "body" }, ...body),
    h("div", { class: "buttons" }, ...buttons),
  );
}

function stepsLine(step: Step): HTMLElement {
  const marks = TEXT.steps.map((name, at) => h("li", { class: at < step ? "is-done" : "", "aria-current": at === step && "step" }, h("i", {}, at < step ? icon("check") : at + 1), name));
  return h("ol", { class: "steps" }, ...marks);
}

export function bigButton(label: string, mark: IconName | null, run: () => void, look = ""): HTMLButtonElement {
  return h("button", { type: "button", class: `big ${look}`, on: { click: run } }, mark && icon(mark), label);
}

/** A button that opens the camera or the phone's own pictures. */
export function picker(label: string, mark: IconName, accept: string, camera: boolean, take: (files: File[]) => void, look = ""): HTMLElement {
  const input = h("input", { type: "file", accept, multiple: true, capture: camera && "environment", class: "file" });
  input.addEventListener("change", () => {
    const files = [...(input.files ?? [])];
    input.value = ""; // The same photo may be chosen again after a mistake.
    if (files.length) take(files);
  });
  return h("label", { class: `big ${look}` }, icon(mark), h("span", {}, label), input);
}

export function trouble(text: string): HTMLElement | false {
  return text !== "" && h("p", { class: "trouble", role: "alert" }, icon("warn"), h("span", {}, capital(text)));
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

export function takeScreen(take: (files: File[]) => void, why: string): HTMLElement {
  const words = TEXT.take;
  return screen(
    0,
    words.title,
    [h("p", { class: "lead" }, words.lead), trouble(why), drawnRoom(), tips(words.tips)],
    [
      picker(words.film, "video", "video/*", true, take, "is-main"),
      picker(words.photo, "photo", "image/*", true, take),
      picker(words.choose, "folder", "image/*,video/*", false, take, "is-quiet"),
    ],
  );
}

export function chosenScreen(picks: Picks, take: (files: File[]) => void, go: () => void, over: () => void, why: string): HTMLElement {
  const words = TEXT.chosen;
  const isVideo = picks.kind === "video";
  const count = picks.files.length;
  const hint = isVideo ? words.videoHint : count < GOOD_PHOTOS ? words.few(GOOD_PHOTOS - count) : words.enough;
  const size = h("span", { class: "size" }, TEXT.size(bytesOf(picks.files)));
  return screen(
    0,
    isVideo ? words.video : words.photos(count),
    [h("p", { class: "lead" }, size, hint), trouble(why), isVideo ? h("div", { class: "clip" }, icon("video"), picks.files[0]!.name) : thumbs(picks.files)],
    [
      bigButton(words.build, "cube", go, "is-main"),
      !isVideo && h("div", { class: "pair" }, picker(words.more, "photo", "image/*", true, take), picker(words.morePick, "folder", "image/*", false, take)),
      bigButton(words.over, null, over, "is-quiet"),
    ],
  );
}

/** Small pictures of the first photos. One that the browser cannot read is a mark. */
function thumbs(files: readonly File[]): HTMLElement {
  const rest = files.length - MOST_THUMBS;
  const shown = files.slice(0, rest > 1 ? MOST_THUMBS : MOST_THUMBS + 1);
  const tiles = shown.map(() => h("li", {}, icon("photo")));
  void (async () => {
    for (const [at, file] of shown.entries()) {
      const drawn = await thumb(file).catch(() => null);
      if (drawn) fill(tiles[at]!, drawn);
    }
  })();
  return h("ul", { class: "thumbs" }, ...tiles, rest > 1 && h("li", { class: "more" }, TEXT.chosen.others(rest)));
}

async function thumb(file: File): Promise<HTMLCanvasElement> {
  const picture = await createImageBitmap(file, { resizeWidth: THUMB_PX, resizeQuality: "medium" });
  const canvas = h("canvas", { width: picture.width, height: picture.height });
  canvas.getContext("2d")?.drawImage(picture, 0, 0);
  picture.close();
  return canvas;
}

export interface WorkScreen {
  node: HTMLElement;
  show(share: number, stage: string, left: string): void;
  warn(text: string): void;
}

/** Sending or building: a large number, a bar, the stage and the time left. */
export function workScreen(title: string, note: string, cancel: () => void): WorkScreen {
  const number = h("output", { class: "percent" });
  const bar = h("progress", { class: "progress-bar", max: 1, "aria-label": title });
  const stage = h("strong", { class: "stage" });
  const left = h("span", { class: "left" });
  const room = drawnRoom();
  room.classList.add("is-working");
  const warning = h("div", { class: "warning" });
  const node = screen(
    1,
    title,
    [h("div", { class: "work" }, number, bar, h("div", { class: "work-words", "aria-live": "polite" }, stage, left)), warning, h("p", { class: "lead" }, note), room],
    [bigButton(TEXT.build.cancel, null, cancel, "is-quiet")],
  );
  return {
    node,
    show(share, name, rest) {
      fill(number, `${Math.floor(share * 100)} %`);
      bar.value = share;
      fill(stage, name);
      fill(left, rest);
    },
    warn(text) {
      fill(warning, trouble(text));
    },
  };
}

export function stageOf(job: JobState): string {
  const steps = job.total > 1 && job.total !== 100 ? ` ${job.done} / ${job.total}` : "";
  return `${TEXT.stages[job.stage] ?? (job.stage || TEXT.build.waiting)}${steps}`;
}

export function leftOf(job: JobState): string {
  return job.left_s === null || !job.stage ? "" : TEXT.left(timeOf(job.left_s));
}

export function doneScreen(one: CaptureTold, again: () => void): HTMLElement {
  const words = TEXT.done;
  const room = `${CAPTURES}/${one.id}/room`;
  const { objects = 0, note = "" } = (one.job?.result ?? {}) as { objects?: number; note?: string };
  const picture = h("img", { class: "room-picture", src: `${CAPTURES}/${one.id}/picture`, alt: words.alt });
  return screen(
    2,
    words.title,
    [one.has_page ? h("a", { href: room, class: "room-link" }, picture) : picture, h("p", { class: "lead" }, one.has_page ? words.lead(objects) : words.noPage), trouble(one.has_page ? "" : note)],
    [
      one.has_page && h("a", { class: "big is-main", href: room }, icon("navigate"), words.walk),
      one.has_page && h("a", { class: "big", href: room, download: "room.html" }, icon("save"), words.keep),
      bigButton(words.again, null, again, "is-quiet"),
    ],
  );
}

export function failedScreen(why: string, again: (() => void) | null, fresh: () => void): HTMLElement {
  const words = TEXT.failed;
  return screen(
    1,
    words.title,
    [trouble(why), h("h2", {}, words.help), tips(words.tips)],
    [bigButton(words.fresh, "photo", fresh, "is-main"), again && bigButton(words.again, null, again)],
  );
}

export function scanScreen(why: string): HTMLElement {
  const box = h("div", { class: "scan-mark" }, icon("scan"));
  return screen(null, TEXT.scan.title, [box, h("p", { class: "lead" }, TEXT.scan.lead), trouble(why)], []);
}

function tips(lines: readonly string[]): HTMLElement {
  return h("ul", { class: "tips" }, ...lines.map((line) => h("li", {}, icon("check"), line)));
}

const SPACE = "http://www.w3.org/2000/svg";
// A corner of a room in blocks, and the way around it with a camera.
const ROOM: readonly [string, string][] = [
  ["floor", "M100 44 180 84 100 124 20 84Z"],
  ["wall-left", "M20 84V34L100-6V44Z"],
  ["wall-right", "M100 44V-6L180 34V84Z"],
  ["window", "M122 22 152 37V60L122 45Z"],
  ["box-top", "M64 70 88 82 64 94 40 82Z"],
  ["box-left", "M40 82V64L64 76V94Z"],
  ["box-right", "M64 94V76L88 64V82Z"],
  ["box-lid", "M64 52 88 64 64 76 40 64Z"],
  ["way", "M52 106Q104 122 148 92T120 66"],
];

function drawnRoom(): SVGElement {
  const svg = document.createElementNS(SPACE, "svg");
  svg.setAttribute("viewBox", "0 -10 200 140");
  svg.setAttribute("class", "drawn-room");
  svg.setAttribute("aria-hidden", "true");
  for (const [name, d] of ROOM) {
    const path = document.createElementNS(SPACE, "path");
    path.setAttribute("d", d);
    path.setAttribute("class", name);
    svg.append(path);
  }
  return svg;
}
