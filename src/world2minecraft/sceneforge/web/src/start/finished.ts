// A room that is finished: its picture, and what one does next, each with one click.

import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { plainButton } from "../ui/fields";
import type { JobState } from "../wire";
import { getJson, said, sendJson } from "./api";
import type { Jobs } from "./capture";
import { pickGame } from "./folder_picker";

interface Games {
  games: { id: string; name: string }[];
}

/** The room of a capture's id or of `recent-N`. */
export function finishedRoom(id: string, title: string, jobs: Jobs, open: () => void): HTMLElement {
  const words = TEXT.start.finished;
  const note = h("p", { class: "note", "aria-live": "polite" });
  const say = (text: string): void => fill(note, text);
  const edit = plainButton(words.edit, open, "button is-main is-large");
  edit.dataset.do = "open";
  const report = h("a", { class: "button is-large", href: `api/start/rooms/${id}/report`, target: "_blank", rel: "noopener" }, words.report);
  const install = plainButton(words.install, () => void installRoom(id, jobs, say), "button is-large");
  install.dataset.do = "install";
  const share = plainButton(words.share, () => void shareRoom(id, title, jobs, note), "button is-large");
  share.dataset.do = "share";
  return h(
    "section",
    { class: "finished", "aria-label": words.title },
    h("img", { class: "finished-picture", src: `api/start/rooms/${id}/picture`, alt: words.alt(title) }),
    h("div", { class: "row" }, edit, report, share, install),
    note,
  );
}

async function shareRoom(id: string, title: string, jobs: Jobs, note: HTMLElement): Promise<void> {
  const words = TEXT.start.finished;
  try {
    fill(note, words.sharing);
    const { job } = await sendJson<{ job: string }>(`api/start/rooms/${id}/share`, { title });
    const state = await ended(job, jobs);
    if (state.state !== "done") throw new Error(state.note || TEXT.start.cancelled);
    const made = state.result as { id: string; file: string; bytes: number };
    const link = h("a", { href: `api/exports/files/${made.id}`, download: made.file }, words.shared(made.file, TEXT.start.megabytes(made.bytes / 2 ** 20)));
    fill(note, link);
    link.click();
  } catch (error) {
    fill(note, said(error));
  }
}

async function installRoom(id: string, jobs: Jobs, say: (text: string) => void): Promise<void> {
  const words = TEXT.exports;
  try {
    const { games } = await getJson<Games>("api/exports");
    const game = games[0]?.id ?? (await pickGame());
    if (!game) return;
    const { job } = await sendJson<{ job: string }>(`api/start/rooms/${id}/install`, { game });
    const state = await ended(job, jobs);
    if (state.state !== "done") throw new Error(state.note || TEXT.start.cancelled);
    const made = state.result as { name: string; game: string; note: string };
    say([words.installed(made.name), words.steps(made.game, made.name), made.note].filter(Boolean).join(". "));
  } catch (error) {
    say(said(error));
  }
}

/** The last state of a job, which may have ended before it was listened to. */
function ended(job: string, jobs: Jobs): Promise<JobState> {
  return new Promise((resolve, reject) => {
    const hear = (state: JobState): void => {
      if (state.id !== job || state.state === "running") return;
      stop();
      resolve(state);
    };
    const stop = jobs.on(hear);
    getJson<JobState[]>("api/jobs").then((all) => all.forEach(hear), reject);
  });
}
