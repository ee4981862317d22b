// Gets the blocks of the scene as it is now, and again after edits: one wish at a time.

import type { App } from "../ui/slots";
import { TEXT } from "../text";
import { BlockMesh, type BuildFacts } from "./mesh";

export interface BuildWish {
  size: number; // blocks a metre
  style: string;
}

const QUIET_MS = 300; // after the last edit: strokes come in a row

export class Loader {
  wish: BuildWish = { size: 4, style: "blocks" };
  mesh: BlockMesh<BuildFacts> | null = null;
  busy = false;
  private got = "";
  private running: AbortController | null = null;
  private timer = 0;
  private listeners = new Set<() => void>();
  private waiting: (() => void)[] = [];

  constructor(private readonly app: App) {}

  /** Call back when the blocks change, or when work on them begins or ends. */
  watch(call: () => void): void {
    this.listeners.add(call);
  }

  get key(): string {
    const { scene } = this.app.store.get();
    return scene ? [scene.document, scene.rev, this.wish.size, this.wish.style].join() : "";
  }

  get isFresh(): boolean {
    return this.got === this.key;
  }

  /** Get what is wished, soon; `at once` where it is not an edit among many. */
  refresh(atOnce = false): void {
    clearTimeout(this.timer);
    if (this.isFresh && !this.busy) return;
    this.timer = window.setTimeout(() => void this.load(), atOnce ? 0 : QUIET_MS);
    this.busy = true;
    this.tell();
  }

  /** Resolves when the blocks are those of the scene. */
  idle(): Promise<void> {
    return new Promise((resolve) => {
      if (!this.busy) resolve();
      else this.waiting.push(resolve);
    });
  }

  private async load(): Promise<void> {
    this.running?.abort();
    const running = (this.running = new AbortController());
    const { size, style } = this.wish;
    const key = this.key;
    try {
      const answer = await fetch(`api/build?blocks_per_metre=${size}&style=${style}`, running);
      if (!answer.ok) throw new Error(((await answer.json()) as { error: string }).error);
      const mesh = BlockMesh.read(await answer.arrayBuffer());
      if (running.signal.aborted) return;
      this.mesh = mesh;
      const [document, , ...rest] = key.split(",");
      this.got = [document, mesh.facts.rev, ...rest].join();
    } catch (error) {
      if (running.signal.aborted) return;
      this.got = key; // It would be refused again.
      this.app.toast(error instanceof Error ? error.message : TEXT.build.failed, "error");
    }
    this.busy = false;
    this.tell();
    if (this.key !== this.got) this.refresh();
    else for (const resolve of this.waiting.splice(0)) resolve();
  }

  private tell(): void {
    for (const call of this.listeners) call();
  }
}
