// The wire: loads the document, keeps it in step with the server, and carries what is asked of it.
// The page never changes the document by itself; it applies the changes that the server sends.

import { applyChange } from "./changes";
import type { Store } from "./store";
import { TEXT } from "./text";
import { readVolume } from "./volume";
import type {
  Change,
  ClientMessage,
  Done,
  HeldRun,
  Hello,
  JobState,
  Refused,
  Scene,
  SceneObject,
  ServerMessage,
} from "./wire";
import { PROTOCOL } from "./wire";

export type AnyCommand = { op: string } & Record<string, unknown>;

export interface Preview {
  cells: HeldRun[] | null;
  objects: SceneObject[];
  gone: number[];
}

/** The server holds no document yet: the start page is shown. */
export class NoDocument extends Error {}

interface Waiting {
  resolve(rev: number): void;
  reject(error: Error): void;
}

const RETRIES_MS = [250, 500, 1000, 2000, 5000]; // Guess: a server is back within seconds or not.

export class Connection {
  private socket: WebSocket | null = null;
  private waiting = new Map<number, Waiting>();
  private seq = 0;
  private attempt = 0;
  private greeted = false; // by the socket that is open
  private loading = false;
  private early: Change[] = []; // came while the document was being loaded
  private jobListeners = new Set<(job: JobState) => void>();
  private changeListeners = new Set<(change: Change) => void>();
  private lastActive = 0;

  constructor(private store: Store) {}

  /** Load the document and stay in step with it. Throws NoDocument where there is none. */
  async open(): Promise<void> {
    this.connect();
    await this.load();
  }

  do(command: AnyCommand): Promise<number> {
    return this.send((seq) => ({ type: "do", seq, command }));
  }
  undo(): Promise<number> {
    return this.send((seq) => ({ type: "undo", seq }));
  }
  redo(): Promise<number> {
    return this.send((seq) => ({ type: "redo", seq }));
  }
  save(): Promise<number> {
    return this.send((seq) => ({ type: "save", seq }));
  }
  preview(command: AnyCommand): Promise<Preview> {
    return post<Preview>("api/preview", command);
  }
  ask<T>(name: string, fields: Record<string, unknown> = {}): Promise<T> {
    return post<T>(`api/ask/${name}`, fields);
  }
  cancel(job: string): void {
    this.say({ type: "cancel", job });
  }

  /** The person did something; told at most once a second, to measure effort without idling. */
  active(): void {
    const now = Date.now();
    if (now - this.lastActive < 1000) return;
    this.lastActive = now;
    this.say({ type: "active" });
  }

  onJob(call: (job: JobState) => void): () => void {
    this.jobListeners.add(call);
    return () => this.jobListeners.delete(call);
  }
  onChange(call: (change: Change) => void): () => void {
    this.changeListeners.add(call);
    return () => this.changeListeners.delete(call);
  }

  private connect(): void {
    const url = new URL("api/live", document.baseURI);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url);
    this.socket = socket;
    this.greeted = false;
    socket.onmessage = (event) => this.hear(JSON.parse(event.data as string) as ServerMessage);
    socket.onopen = () => {
      this.attempt = 0;
      this.store.set({ online: true });
    };
    socket.onclose = () => this.lost();
  }

  private lost(): void {
    this.store.set({ online: false });
    this.giveUp(TEXT.error.lost);
    const pause = RETRIES_MS[Math.min(this.attempt, RETRIES_MS.length - 1)] ?? 5000;
    this.attempt += 1;
    setTimeout(() => this.connect(), pause);
  }

  /** No answer will come to what waits. */
  private giveUp(why: string): void {
    for (const one of this.waiting.values()) one.reject(new Error(why));
    this.waiting.clear();
  }

  private hear(message: ServerMessage): void {
    if (message.type === "hello") this.greet(message);
    else if (message.type === "change") this.take(message);
    else if (message.type === "saved") this.saved();
    else if (message.type === "job") this.jobListeners.forEach((call) => call(message));
    else this.answer(message);
  }

  /** Another document, or changes that were missed: everything is got again. */
  private greet(hello: Hello): void {
    if (hello.protocol !== PROTOCOL) {
      this.store.set({ status: TEXT.error.protocol });
      return;
    }
    // A second greeting: this tab did not keep up, and the server dropped what it had to say.
    if (this.greeted) this.giveUp(TEXT.error.behind);
    this.greeted = true;
    const { document, rev } = this.store.get().scene ?? { document: 0, rev: 0 };
    if (document !== hello.document || (document && rev !== hello.rev)) this.reload();
  }

  private reload(): void {
    this.load().catch((error: unknown) => {
      if (error instanceof NoDocument) this.store.set({ scene: null });
      else this.store.set({ status: error instanceof Error ? error.message : TEXT.error.load });
    });
  }

  private take(change: Change): void {
    if (this.loading) {
      this.early.push(change);
      return;
    }
    const scene = this.store.get().scene;
    if (!scene || change.rev <= scene.rev) return;
    if (change.rev !== scene.rev + 1 || change.cells === null) this.reload();
    else applyChange(this.store, change);
    this.changeListeners.forEach((call) => call(change));
  }

  private saved(): void {
    const scene = this.store.get().scene;
    if (scene) this.store.set({ scene: { ...scene, saved: true } });
  }

  private answer(message: Done | Refused): void {
    const waiting = this.waiting.get(message.seq);
    this.waiting.delete(message.seq);
    if (message.type === "done") waiting?.resolve(message.rev);
    else waiting?.reject(new Error(message.error));
  }

  private send(make: (seq: number) => ClientMessage): Promise<number> {
    const seq = ++this.seq;
    return new Promise((resolve, reject) => {
      if (this.socket?.readyState !== WebSocket.OPEN) {
        reject(new Error(TEXT.error.offline));
        return;
      }
      this.waiting.set(seq, { resolve, reject });
      this.say(make(seq));
    });
  }

  private say(message: ClientMessage): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Get everything again, until the parts are of one revision. */
  private async load(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    try {
      for (let tries = 0; tries < 5; tries++) if (await this.loadOnce()) break;
    } finally {
      this.loading = false;
      for (const change of this.early.splice(0)) this.take(change);
    }
  }

  private async loadOnce(): Promise<boolean> {
    const answer = await fetch("api/scene");
    if (answer.status === 404) throw new NoDocument();
    if (!answer.ok) throw new Error(await errorOf(answer));
    const scene = (await answer.json()) as Scene;
    const [labels, instance, confidence] = await Promise.all([
      readVolume("labels"),
      readVolume("instance"),
      readVolume("confidence"),
    ]);
    if ([labels, instance, confidence].some((one) => one.rev !== scene.rev)) return false;
    this.store.set({
      scene,
      labels: labels.cells as Uint8Array,
      instance: instance.cells as Uint16Array,
      confidence: confidence.cells as Uint8Array,
      touched: { rev: scene.rev, runs: null },
      objects: new Map(scene.objects.map((one) => [one.id, one])),
    });
    return true;
  }
}

async function post<T>(path: string, body: unknown): Promise<T> {
  let answer: Response;
  try {
    answer = await fetch(path, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
  } catch {
    throw new Error(TEXT.error.offline);
  }
  if (!answer.ok) throw new Error(await errorOf(answer));
  return (await answer.json()) as T;
}

async function errorOf(answer: Response): Promise<string> {
  try {
    return ((await answer.json()) as { error: string }).error;
  } catch {
    return `${answer.status} ${answer.statusText}`;
  }
}
