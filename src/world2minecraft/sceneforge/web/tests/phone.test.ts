// What a phone gives, and how it is sent over a connection that comes and goes.

import { afterEach, describe, expect, it, vi } from "vitest";

import { added, named, NOTHING, type Limits } from "../src/phone/picks";
import { Refused, Unreached } from "../src/start/api";
import { sendCapture, type Sending } from "../src/start/upload";

const LIMITS: Limits = { most_bytes: 1000, most_photos: 4, photo_suffixes: [".jpg", ".heic"], video_suffixes: [".mp4", ".mov"] };

const file = (name: string, size = 3, type = ""): File => new File([new Uint8Array(size)], name, { type });

describe("added", () => {
  it("gives photos of one name names of their own, in their order", () => {
    const once = added(NOTHING, [file("image.jpg"), file("image.jpg")], LIMITS);
    const twice = added(once, [file("IMG.HEIC")], LIMITS);
    expect(named(twice).map((one) => one.path)).toEqual(["0001.jpg", "0002.jpg", "0003.heic"]);
    expect(once.files).toHaveLength(2);
  });

  it("takes one video, and knows kinds without a suffix by their type", () => {
    expect(named(added(NOTHING, [file("IMG_1.MOV")], LIMITS))[0]!.path).toBe("video.mov");
    expect(named(added(NOTHING, [file("image", 3, "image/jpeg")], LIMITS))[0]!.path).toBe("0001.jpg");
  });

  it.each([
    [[file("notes.pdf")], "neither a photo nor a video"],
    [[file("a.jpg", 0)], "empty"],
    [[file("a.jpg"), file("b.mp4")], "photos, or one video"],
    [[file("a.mp4"), file("b.mp4")], "photos, or one video"],
    [[file("a.mp4"), file("b.jpg")], "photos, or one video"],
    [[file("a.mp4", 1001)], "the limit is"],
    [Array.from({ length: 5 }, () => file("a.jpg")), "More than 4 photos"],
  ])("says what is wrong with other files", (files, why) => {
    expect(() => added(NOTHING, files, LIMITS)).toThrow(why);
  });
});

/** A server that loses connections: it keeps a part of what was under way, and says how much. */
class Server {
  readonly held: Uint8Array[];
  asked = 0;

  constructor(
    readonly sizes: readonly number[],
    readonly lose: (nth: number) => "no" | "part" | "answer" | "busy",
  ) {
    this.held = sizes.map(() => new Uint8Array());
  }

  async fetch(path: string, init?: RequestInit): Promise<Response> {
    if (init?.method === "POST") return Response.json({ id: "x", title: "", files: this.sizes.map((size, n) => ({ path: `${n}.jpg`, size })) });
    if (!init?.method) return Response.json({ held: this.held.map((one) => one.length) });
    const [, index, at] = /files\/(\d+)\?at=(\d+)/.exec(path)!.map(Number);
    const now = this.held[index!]!;
    const how = this.lose(this.asked++);
    if (how === "busy" || at !== now.length) return Response.json({ error: "continue from there" }, { status: 409 });
    const bytes = new Uint8Array(await (init.body as Blob).arrayBuffer());
    const kept = how === "part" ? bytes.slice(0, bytes.length >> 1) : bytes;
    this.held[index!] = new Uint8Array([...now, ...kept]);
    if (how !== "no") throw new TypeError("Failed to fetch");
    return Response.json({ held: this.held[index!]!.length });
  }
}

describe("sendCapture", () => {
  afterEach(() => {
    vi.unstubAllGlobals();
    vi.useRealTimers();
  });

  const bytes = (seed: number, size: number): Uint8Array<ArrayBuffer> => Uint8Array.from({ length: size }, (_, n) => (n * 31 + seed * 17) % 251);

  async function sent(server: Server, how: Partial<Sending> = {}): Promise<unknown> {
    vi.useFakeTimers();
    vi.stubGlobal("fetch", server.fetch.bind(server));
    const given = server.sizes.map((size, n) => ({ path: `${n}.jpg`, file: new File([bytes(n, size)], `${n}.jpg`) }));
    const all = sendCapture("", given, { base: "c", chunkBytes: 7, tries: Infinity, ...how }, () => undefined, new AbortController().signal);
    const settled = all.catch((error: unknown) => error);
    let done = false;
    void settled.then(() => (done = true));
    while (!done) await vi.advanceTimersByTimeAsync(1000);
    return settled;
  }

  it.each([1, 2, 3, 4, 5, 6, 7, 8])("arrives whole whatever is lost on the way (%i)", async (seed) => {
    let state = seed;
    const dice = (): number => (state = (state * 1103515245 + 12345) % 2 ** 31) / 2 ** 31;
    const server = new Server([40, 1, 23], () => (dice() < 0.4 ? "no" : dice() < 0.4 ? "part" : dice() < 0.5 ? "answer" : "busy"));
    const told: boolean[] = [];
    expect(await sent(server, { lost: (isLost) => told.push(isLost) })).toBe("x");
    server.held.forEach((held, n) => expect(held).toEqual(bytes(n, server.sizes[n]!)));
    expect(told.at(-1)).toBe(false);
  });

  it("gives up after so many tries, and at once where the server refuses", async () => {
    const dead = new Server([9], () => "answer");
    dead.held[0] = new Uint8Array();
    vi.spyOn(dead, "fetch").mockImplementation(async (path, init) => {
      if (init?.method === "POST") return Response.json({ id: "x", title: "", files: [{ path: "0.jpg", size: 9 }] });
      throw new TypeError(path);
    });
    expect(await sent(dead, { tries: 3 })).toBeInstanceOf(Unreached);
    const full = new Server([9], () => "no");
    vi.spyOn(full, "fetch").mockImplementation(async (_, init) =>
      init?.method === "POST" ? Response.json({ id: "x", title: "", files: [{ path: "0.jpg", size: 9 }] }) : Response.json({ error: "the disk is full" }, { status: 400 }),
    );
    const error = await sent(full);
    expect(error).toBeInstanceOf(Refused);
    expect((error as Refused).message).toBe("the disk is full");
  });
});
