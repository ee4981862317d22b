// One capture on the start page: looked at, chosen for, made into a room, opened.

import { progressLine, type ProgressLine } from "../jobs/progress";
import { TEXT } from "../text";
import { fill, h, setWhy } from "../ui/dom";
import { plainButton } from "../ui/fields";
import type { JobState } from "../wire";
import { forget, getJson, said, sendJson } from "./api";
import { makeChoices } from "./choices";
import { finishedRoom } from "./finished";
import { foundBody, foundHead } from "./found";
import { LiveView } from "./live";
import type { CaptureTold, StartTold } from "./told";

export interface Jobs {
  on(call: (job: JobState) => void): () => void;
  cancel(id: string): void;
}

/** Show a capture in `host` until `leave` is called. Returns what ends it. */
export function showCapture(host: HTMLElement, id: string, told: StartTold, jobs: Jobs, leave: () => void, changed: () => void): () => void {
  const words = TEXT.start;
  const title = h("h2", {});
  const body = h("div", { class: "capture-body" });
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const back = plainButton(words.back, leave, "button back");
  fill(host, h("div", { class: "capture-head" }, back, title), trouble, body);
  let looked: CaptureTold | null = null; // Its picture stays in view while the room is made.
  let working: { id: string; line: ProgressLine; live: LiveView | null } | null = null;

  let stage = "";

  const complain = (text: string): void => {
    trouble.textContent = text;
    trouble.hidden = !text;
  };

  const watch = (job: string, name: string, making: boolean): void => {
    const line = progressLine(name, () => jobs.cancel(job));
    working?.live?.dispose();
    const live = making ? new LiveView(job) : null;
    working = { id: job, line, live };
    fill(body, line.node, live?.node, looked && foundBody(looked, looked.survey!));
    void live?.refresh();
    complain("");
    changed();
  };

  const ask = async (path: string, what: unknown, name: string, making: boolean): Promise<void> => {
    try {
      const { job } = await sendJson<{ job: string }>(`api/start/captures/${id}/${path}`, what);
      watch(job, name, making);
      await catchUp(job);
    } catch (error) {
      complain(said(error));
    }
  };

  /** A short job may be over before its messages are listened to. */
  const catchUp = async (job: string): Promise<void> => {
    const all = await getJson<JobState[]>("api/jobs");
    const found = all.find((one) => one.id === job);
    if (found) hear(found);
  };

  const open = async (): Promise<void> => {
    try {
      await sendJson("api/start/open", { id });
      location.reload();
    } catch (error) {
      complain(said(error));
    }
  };

  const hear = (job: JobState): void => {
    if (!working || job.id !== working.id) return;
    if (job.state === "running") {
      working.line.show(job);
      if (job.stage !== stage) void working.live?.refresh();
      stage = job.stage;
      return;
    }
    working.live?.dispose();
    working = null;
    void refresh(job.state === "failed" ? job.note : job.state === "cancelled" ? words.cancelled : "");
  };

  const refresh = async (note = ""): Promise<void> => {
    let one: CaptureTold;
    try {
      one = await getJson<CaptureTold>(`api/start/captures/${id}`);
    } catch (error) {
      complain(said(error));
      return;
    }
    title.textContent = one.title;
    looked = one.survey ? one : null;
    if (!one.job) changed();
    if (one.job) {
      watch(one.job, one.survey ? words.making : words.looking, Boolean(one.survey));
      await catchUp(one.job);
    } else if (one.complete && !one.survey && !note) await ask("look", {}, words.looking, false);
    else {
      showReady(one);
      complain(one.complete ? note : words.why.notWhole);
    }
  };

  const showReady = (one: CaptureTold): void => {
    const { survey } = one;
    const start = plainButton(one.has_room ? words.again : words.start, () => begin(), one.has_room ? "button is-large" : "button is-main is-large");
    start.dataset.do = "start";
    const choices = survey && makeChoices(told, survey, () => show());
    const show = (): void => {
      const why = survey?.can_start ? (choices?.why() ?? "") : words.why.stop;
      setWhy(start, why, start.textContent ?? "");
    };
    const begin = (): void => {
      if (choices) void ask("reconstruct", choices.choice(), words.making, true);
    };
    fill(
      body,
      one.has_room && finishedRoom(id, one.title, jobs, () => void open()),
      survey && foundHead(survey),
      choices?.node,
      h("div", { class: "row" }, survey && start, remover(id, leave, complain)),
      survey && foundBody(one, survey),
    );
    show();
  };

  const stop = jobs.on(hear);
  void refresh();
  return () => {
    stop();
    working?.live?.dispose();
  };
}

function remover(id: string, leave: () => void, complain: (text: string) => void): HTMLElement {
  const words = TEXT.start;
  let sure = false;
  const button = plainButton(words.remove, () => {
    if (!sure) {
      sure = true;
      button.textContent = words.removeConfirm;
      return;
    }
    forget(`api/start/captures/${id}`).then(leave, (error) => complain(said(error)));
  }, "button is-danger is-quiet");
  return button;
}
