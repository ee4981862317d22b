// A job as a person sees it: what is being done, how far it is, how long it takes still.

import { h, fill } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { TEXT } from "../text";
import type { JobState } from "../wire";

export function timeOf(seconds: number): string {
  const { start } = TEXT;
  if (seconds < 55) return start.seconds(Math.max(Math.ceil(seconds / 5) * 5, 5));
  return start.minutes(Math.max(Math.round(seconds / 60), 1));
}

export interface ProgressLine {
  node: HTMLElement;
  show(job: Pick<JobState, "stage" | "done" | "total" | "left_s" | "note"> & { share?: number | null }): void;
  say(words: string): void;
}

/** A bar with words; `cancel` adds a button. */
export function progressLine(title: string, cancel?: () => void): ProgressLine {
  const words = h("span", { class: "progress-words" });
  const left = h("span", { class: "note" });
  const bar = h("progress", { class: "progress-bar", max: 1, "aria-label": title });
  const node = h(
    "div",
    { class: "progress" },
    h("div", { class: "progress-head" }, h("strong", {}, title), cancel && plainButton(TEXT.start.cancel, cancel)),
    bar,
    h("div", { class: "progress-foot" }, words, left),
  );
  return {
    node,
    show({ stage, done, total, share, left_s }) {
      const part = share ?? (total ? done / total : null);
      if (part === null) bar.removeAttribute("value");
      else bar.value = part;
      const steps = total > 1 && total !== 100 ? ` ${done} / ${total}` : "";
      fill(words, `${TEXT.start.stages[stage] ?? stage}${steps}`);
      fill(left, left_s === null || !stage ? "" : TEXT.start.left(timeOf(left_s)));
    },
    say(text) {
      fill(words, text);
    },
  };
}
