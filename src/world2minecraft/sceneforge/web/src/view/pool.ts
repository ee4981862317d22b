// Two workers that mesh chunks, and the queue in front of them.

import type { LoadOrder, Meshed, MeshOrder } from "./worker";
import type { Vec3 } from "../wire";

export type Job = Omit<MeshOrder, "type">;

const WORKERS = 2;
const AHEAD = 3; // Orders a worker holds, so that it never waits for the page.

export class Pool {
  private workers: { worker: Worker; busy: number; stale: boolean }[] = [];
  private queue: Job[] = [];
  private readonly sent = new Set<string>();
  private volume: { labels: Uint8Array; shape: Vec3 } | null = null;

  constructor(private readonly done: (meshed: Meshed) => void) {}

  /** How many orders are not answered. */
  get open(): number {
    return this.queue.length + this.workers.reduce((sum, { busy }) => sum + busy, 0);
  }

  /** The labels are others now: workers get them with their next order. */
  setVolume(labels: Uint8Array, shape: Vec3): void {
    this.volume = { labels, shape };
    for (const entry of this.workers) entry.stale = true;
  }

  /** Orders that wait are replaced by these, first first. */
  replace(jobs: Job[]): void {
    this.queue = jobs.filter((job) => !this.sent.has(nameOf(job))).reverse();
    if (this.queue.length) this.start();
    this.feed();
  }

  dispose(): void {
    this.queue = [];
    for (const { worker } of this.workers) worker.terminate();
    this.workers = [];
  }

  private start(): void {
    while (this.workers.length < WORKERS) {
      const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
      const entry = { worker, busy: 0, stale: true };
      worker.onmessage = ({ data }: MessageEvent<Meshed>) => {
        entry.busy -= 1;
        this.sent.delete(nameOf(data));
        this.feed();
        this.done(data);
      };
      this.workers.push(entry);
    }
  }

  private feed(): void {
    if (!this.volume) return;
    for (let round = 0; round < AHEAD; round++) {
      for (const entry of this.workers) {
        if (entry.busy > round) continue;
        const job = this.queue.pop();
        if (!job) return;
        if (entry.stale) {
          const order: LoadOrder = { type: "load", epoch: job.epoch, ...this.volume };
          entry.worker.postMessage(order);
          entry.stale = false;
        }
        entry.busy += 1;
        this.sent.add(nameOf(job));
        entry.worker.postMessage({ type: "mesh", ...job } satisfies MeshOrder);
      }
    }
  }
}

function nameOf({ key, epoch, step, style }: Pick<Job, "key" | "epoch" | "step" | "style">): string {
  return `${key} ${epoch} ${step} ${style}`;
}
