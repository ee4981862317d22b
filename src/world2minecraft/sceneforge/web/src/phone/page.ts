// The phone page: what a person takes goes to the computer, and comes back as a room.

import { Refused, said, Unreached } from "../start/api";
import { sendCapture } from "../start/upload";
import { fill } from "../ui/dom";
import { added, named, NOTHING, type Picks } from "./picks";
import { chosenScreen, doneScreen, failedScreen, leftOf, scanScreen, screen, stageOf, takeScreen, workScreen, type WorkScreen } from "./screens";
import { TEXT } from "./text";
import { build, cancel, capture, CAPTURES, overview, pair, type CaptureTold, type PhoneTold } from "./told";

const POLL_MS = 1000;
const STALL_MS = 20_000; // A chunk of a megabyte takes a tenth of it in the slowest Wi-Fi.

export class PhonePage {
  private told: PhoneTold | null = null;
  private picks: Picks = NOTHING;

  constructor(private readonly host: HTMLElement) {}

  /** Let the phone in, and show what it was doing. */
  async start(): Promise<void> {
    this.show(screen(null, TEXT.loading, [], []));
    let why = "";
    try {
      await pair().catch((error: unknown) => {
        why = said(error); // A phone that is let in already needs no code.
      });
      this.told = await overview();
    } catch (error) {
      if (error instanceof Refused) return this.show(scanScreen(why));
      this.show(failedScreen(TEXT.build.lost, () => void this.start(), () => void this.start()));
      return;
    }
    const last = this.told.capture;
    if (last?.job || last?.has_room) this.follow(last);
    else this.take(last && !last.complete ? TEXT.take.interrupted : "");
  }

  private show(node: HTMLElement): void {
    fill(this.host, node);
    node.querySelector("h1")?.focus({ preventScroll: true });
    scrollTo(0, 0);
  }

  private take(why = ""): void {
    this.picks = NOTHING;
    this.show(takeScreen((files) => this.add(files), why));
  }

  private add(files: File[]): void {
    let why = "";
    try {
      this.picks = added(this.picks, files, this.told!);
    } catch (error) {
      why = said(error);
    }
    if (this.picks.kind === "none") this.take(why);
    else this.choose(why);
  }

  private choose(why = ""): void {
    this.show(chosenScreen(this.picks, (files) => this.add(files), () => void this.send(), () => this.take(), why));
  }

  private async send(): Promise<void> {
    const stop = new AbortController();
    const work = workScreen(TEXT.send.title, TEXT.send.note, () => stop.abort());
    this.show(work.node);
    const step = (done: number, total: number): void => work.show(done / Math.max(total, 1), TEXT.send.stage(TEXT.size(done), TEXT.size(total)), "");
    const how = {
      base: CAPTURES,
      chunkBytes: this.told!.chunk_bytes,
      tries: Infinity,
      stallMs: STALL_MS,
      lost: (isLost: boolean) => work.warn(isLost ? TEXT.send.lost : ""),
    };
    try {
      await this.make(await sendCapture("", named(this.picks), how, step, stop.signal));
    } catch (error) {
      if (stop.signal.aborted) this.choose();
      else if (error instanceof Refused && error.status === 401) this.show(scanScreen(""));
      else this.choose(error instanceof Unreached ? TEXT.build.lost : `${TEXT.refused} ${said(error)}`);
    }
  }

  /** Show a capture that is being built until its room is there, or will not be. */
  private follow(one: CaptureTold): void {
    if (one.job?.state !== "running") return this.end(one);
    const stop = (): void => void cancel(one.id).catch(() => undefined);
    const work = workScreen(TEXT.build.title, TEXT.build.note, stop);
    this.show(work.node);
    this.report(work, one);
    void this.poll(work, one.id);
  }

  private async poll(work: WorkScreen, id: string): Promise<void> {
    for (;;) {
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
      try {
        const one = await capture(id);
        work.warn("");
        if (one.job?.state !== "running") return this.end(one);
        this.report(work, one);
      } catch (error) {
        if (error instanceof Refused) return this.show(error.status === 401 ? scanScreen("") : failedScreen(TEXT.failed.gone, null, () => this.take()));
        work.warn(TEXT.build.lost);
      }
    }
  }

  private report(work: WorkScreen, { job }: CaptureTold): void {
    if (job) work.show(job.share ?? 0, stageOf(job), leftOf(job));
  }

  private end(one: CaptureTold): void {
    const { job } = one;
    if (one.has_room && (!job || job.state === "done")) return this.show(doneScreen(one, () => this.take()));
    const why = job?.state === "failed" ? job.note.replace(`${one.title}: `, "") : job?.state === "cancelled" ? TEXT.failed.cancelled : TEXT.failed.gone;
    this.show(failedScreen(why, () => void this.make(one.id), () => this.take()));
  }

  /** Have a capture built that is on the computer, and follow it. */
  private async make(id: string): Promise<void> {
    try {
      const why = await build(id).then(() => "", said); // A lost answer may hide that it has begun.
      const one = await capture(id);
      if (why && one.job?.state !== "running") throw new Error(why);
      this.follow(one);
    } catch (error) {
      if (error instanceof Refused && error.status === 401) return this.show(scanScreen(""));
      const why = error instanceof Unreached ? TEXT.build.lost : said(error);
      this.show(failedScreen(why, () => void this.make(id), () => this.take()));
    }
  }
}
