import { afterEach, expect, test, vi } from "vitest";

import { Connection } from "../src/connection";
import { Store } from "../src/store";
import { TEXT } from "../src/text";

class FakeSocket {
  static readonly OPEN = 1;
  static last: FakeSocket;
  readyState = 1;
  sent: Record<string, unknown>[] = [];
  onmessage: (event: { data: string }) => void = () => undefined;
  onopen: () => void = () => undefined;
  onclose: () => void = () => undefined;

  constructor() {
    FakeSocket.last = this;
  }
  send(text: string): void {
    this.sent.push(JSON.parse(text) as Record<string, unknown>);
  }
  hear(message: object): void {
    this.onmessage({ data: JSON.stringify(message) });
  }
}

const HELLO = { type: "hello", protocol: 1, rev: 0, document: 0 };

function opened(): Connection {
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("document", { baseURI: "http://here/" });
  vi.stubGlobal("fetch", () => Promise.resolve({ status: 404, ok: false }));
  const connection = new Connection(new Store());
  connection.open().catch(() => undefined);
  FakeSocket.last.onopen();
  FakeSocket.last.hear(HELLO);
  return connection;
}

afterEach(() => vi.unstubAllGlobals());

test("an answer resolves what waits for it", async () => {
  const waiting = opened().undo();
  FakeSocket.last.hear({ type: "done", seq: FakeSocket.last.sent[0]!.seq, rev: 7 });
  expect(await waiting).toBe(7);
});

test("the first greeting of a socket ends nothing that waits", async () => {
  const connection = opened();
  const waiting = connection.undo();
  FakeSocket.last.hear({ type: "refused", seq: FakeSocket.last.sent[0]!.seq, error: "no" });
  await expect(waiting).rejects.toThrow("no");
});

test("a second greeting says that what waits is not known: its answer was dropped", async () => {
  const waiting = opened().undo();
  FakeSocket.last.hear(HELLO);
  await expect(waiting).rejects.toThrow(TEXT.error.behind);
});
