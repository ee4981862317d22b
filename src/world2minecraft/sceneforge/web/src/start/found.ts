// What was found in a capture: its picture, its facts, its doubts with what to do about them.

import { TEXT } from "../text";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { timeOf } from "../jobs/progress";
import type { CaptureTold, Doubt, Survey } from "./told";

const MARKS = { ok: "check", warn: "warn", stop: "close" } as const;
const WORST_FIRST = ["stop", "warn", "ok"];

/** What it is, and what to mind. */
export function foundHead(survey: Survey): HTMLElement {
  const doubts = [...survey.doubts]
    .sort((a, b) => WORST_FIRST.indexOf(a.level) - WORST_FIRST.indexOf(b.level))
    .map(doubtRow);
  return h(
    "section",
    { class: "survey", "aria-label": TEXT.start.found },
    h("h3", {}, TEXT.start.found),
    h("p", { class: "survey-called" }, `${survey.called}, ${TEXT.start.about(timeOf(survey.about_s))}`),
    doubts.length > 0 && h("ul", { class: "doubts" }, ...doubts),
  );
}

/** Its picture and its facts. */
export function foundBody(one: CaptureTold, survey: Survey): HTMLElement {
  const facts = survey.lines.map(([name, text]) => [h("dt", {}, name), h("dd", {}, text)]).flat();
  const picture =
    survey.kind === "frames" &&
    h("a", { class: "survey-picture", href: pictureOf(one.id), target: "_blank", rel: "noopener" },
      h("img", { src: pictureOf(one.id), alt: survey.called, width: 1600, height: 1040 }));
  return h("section", { class: "survey" }, picture, h("dl", { class: "facts" }, ...facts));
}

function doubtRow(doubt: Doubt): HTMLElement {
  return h(
    "li",
    { class: `doubt is-${doubt.level}` },
    icon(MARKS[doubt.level]),
    h("div", {}, h("span", {}, doubt.text), doubt.level !== "ok" && doubt.advice && h("p", { class: "note" }, doubt.advice)),
  );
}

function pictureOf(id: string): string {
  return `api/start/captures/${id}/picture.png`;
}
