// The page for a server without a room: drop a capture, or take up a room that is there.

import { progressLine } from "../jobs/progress";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { icon, type IconName } from "../ui/icons";
import { registerStartPage, type App } from "../ui/slots";
import type { JobState } from "../wire";
import { getJson, said, sendJson } from "./api";
import { showCapture, type Jobs } from "./capture";
import { contentsOf, filesOfDrop, filesOfInput, titleOf, type Given } from "./files";
import { finishedRoom } from "./finished";
import { LiveView } from "./live";
import { phonePanel } from "./phone_panel";
import { roomsView } from "./rooms";
import type { StartTold } from "./told";
import { sendCapture } from "./upload";

export function registerStart(): void {
  registerStartPage((host, app) => new StartPage(host, app));
}

class StartPage {
  private readonly main = h("div", { class: "start-main" });
  private readonly aside = h("aside", { class: "start-rooms", "aria-label": TEXT.start.rooms });
  private readonly trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  private readonly jobs: Jobs;
  private told: StartTold | null = null;
  private leave: () => void = () => undefined;

  constructor(host: HTMLElement, app: App) {
    this.jobs = {
      on: (call) => app.connection.onJob(call),
      cancel: (id) => app.connection.cancel(id),
    };
    const head = h("header", { class: "start-head" }, h("h1", {}, TEXT.start.title), h("p", {}, TEXT.start.lead));
    host.append(h("div", { class: "start-sheet" }, head, this.trouble, h("div", { class: "start-columns" }, this.main, this.aside)));
    this.takeDrops(host);
    void this.refresh(true);
  }

  private async refresh(first = false): Promise<void> {
    try {
      this.told = await getJson<StartTold>("api/start");
    } catch (error) {
      this.complain(said(error));
      return;
    }
    fill(
      this.aside,
      roomsView(this.told, {
        look: (id) => this.show(id),
        open: (id) => void this.open(id),
        demo: (kind) => void this.demo(kind),
      }),
    );
    if (first && this.told.wanted) this.show(this.told.wanted);
    else if (first) this.showDrop();
  }

  private complain(text: string): void {
    this.trouble.textContent = text;
    this.trouble.hidden = !text;
  }

  private showDrop(): void {
    this.leave();
    const words = TEXT.start;
    const files = h("input", { type: "file", multiple: true, hidden: true, data: { pick: "files" } });
    const folder = h("input", { type: "file", webkitdirectory: true, hidden: true, data: { pick: "folder" } });
    for (const input of [files, folder]) {
      input.addEventListener("change", () => void this.take(filesOfInput(input)));
    }
    const limit = words.megabytes((this.told?.most_bytes ?? 0) / 2 ** 20);
    const phone = this.told?.phone;
    const drop = h(
      "div",
      { class: "drop" },
      icon("export"),
      h("strong", {}, words.drop),
      h("p", {}, words.dropHint),
      h("div", { class: "row" }, plainButton(words.chooseFiles, () => files.click(), "button is-main"), plainButton(words.chooseFolder, () => folder.click())),
      h("p", { class: "note" }, words.limit(limit)),
      files,
      folder,
    );
    const works = phone ? words.kindsOfCapture : [...words.kindsOfCapture, ["scan", ...words.phone.off] as const];
    fill(
      this.main,
      h("div", { class: "start-ways" }, drop, phone && phonePanel(phone, () => void this.refresh())),
      h("h2", {}, words.works),
      h("ul", { class: "works" }, ...works.map(([mark, name, hint]) => workRow(mark, name!, hint!))),
    );
  }

  private show(id: string): void {
    if (!this.told) return;
    this.leave();
    this.complain("");
    const back = (): void => {
      this.showDrop();
      void this.refresh();
    };
    this.leave = showCapture(this.main, id, this.told, this.jobs, back, () => void this.refresh());
  }

  private async take(given: readonly Given[]): Promise<void> {
    this.complain("");
    if (!given.length || !this.told) {
      this.complain(TEXT.start.nothingDropped);
      return;
    }
    this.leave();
    const stop = new AbortController();
    const line = progressLine(TEXT.start.sendingTitle, () => stop.abort());
    fill(this.main, h("h2", {}, contentsOf(given)), line.node);
    const size = (bytes: number): string => TEXT.start.megabytes(bytes / 2 ** 20);
    const step = (done: number, total: number): void => {
      line.show({ stage: "", done: 0, total: 0, left_s: null, note: "", share: total ? done / total : 0 });
      line.say(TEXT.start.sending(size(done), size(total)));
    };
    const how = { base: "api/start/captures", chunkBytes: this.told.chunk_bytes, tries: 6 };
    try {
      const id = await sendCapture(titleOf(given), given, how, step, stop.signal);
      await this.refresh();
      this.show(id);
    } catch (error) {
      this.showDrop();
      this.complain(stop.signal.aborted ? TEXT.start.cancelled : said(error));
    }
  }

  /** Show a room that has just been made up. */
  private finish(id: string, title: string): void {
    this.leave();
    this.leave = () => undefined;
    const back = plainButton(TEXT.start.back, () => this.showDrop(), "button back");
    const room = finishedRoom(id, title, this.jobs, () => void this.open(id));
    fill(this.main, h("div", { class: "capture-head" }, back, h("h2", {}, title)), h("div", { class: "capture-body" }, room));
    void this.refresh();
  }

  private async open(id: string): Promise<void> {
    try {
      await sendJson("api/start/open", { id });
      location.reload();
    } catch (error) {
      this.complain(said(error));
    }
  }

  private async demo(kind: string): Promise<void> {
    this.complain("");
    try {
      const { job } = await sendJson<{ job: string }>("api/start/demo", { kind });
      this.leave();
      const line = progressLine(TEXT.start.kinds[kind] ?? kind, () => this.jobs.cancel(job));
      const live = new LiveView(job);
      fill(this.main, line.node, live.node);
      let stage = "";
      const hear = (state: JobState): void => {
        if (state.id !== job) return;
        if (state.state === "running") {
          line.show(state);
          if (state.stage !== stage) void live.refresh();
          stage = state.stage;
        } else if (state.state === "done") this.finish("recent-0", state.title);
        else {
          this.showDrop();
          this.complain(state.state === "failed" ? state.note : TEXT.start.cancelled);
        }
      };
      const stop = this.jobs.on(hear);
      this.leave = () => {
        stop();
        live.dispose();
      };
    } catch (error) {
      this.complain(said(error));
    }
  }

  /** Files may be dropped anywhere on the page, also while another capture is shown. */
  private takeDrops(host: HTMLElement): void {
    let depth = 0;
    const lit = (on: boolean): void => void host.classList.toggle("is-over", on);
    const isFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
    host.addEventListener("dragenter", (event) => {
      if (!isFiles(event)) return;
      event.preventDefault();
      depth += 1;
      lit(true);
    });
    host.addEventListener("dragover", (event) => isFiles(event) && event.preventDefault());
    host.addEventListener("dragleave", () => {
      depth = Math.max(depth - 1, 0);
      lit(depth > 0);
    });
    host.addEventListener("drop", (event) => {
      event.preventDefault();
      depth = 0;
      lit(false);
      if (event.dataTransfer) {
        filesOfDrop(event.dataTransfer).then((given) => this.take(given), (error) => this.complain(said(error)));
      }
    });
  }
}

function workRow(mark: IconName, name: string, hint: string): HTMLElement {
  return h("li", {}, icon(mark), h("div", {}, h("strong", {}, name), h("span", { class: "note" }, hint)));
}
