// A capture on its way to the server: in chunks, gone on with where a connection was lost.

import { getJson, Refused, sendBytes, sendJson, Unreached } from "./api";
import type { Given } from "./files";

export interface Announced {
  id: string;
  title: string;
  files: { path: string; size: number }[];
}

/** How a capture is sent. */
export interface Sending {
  base: string; // the path of the captures
  chunkBytes: number;
  tries: number; // to reach the server, one after the other
  stallMs?: number; // a chunk that takes longer is given up, and gone on with
  lost?: (isLost: boolean) => void;
}

const WAIT_MS = 500;
const MOST_WAIT_MS = 3000;

/** Send all files; `step` is told the bytes that are there. Returns the capture's id. */
export async function sendCapture(
  title: string,
  given: readonly Given[],
  how: Sending,
  step: (done: number, total: number) => void,
  stop: AbortSignal,
): Promise<string> {
  const files = given.map(({ path, file }) => ({ path, size: file.size }));
  const made = await sendJson<Announced>(how.base, { title, files });
  const byPath = matched(given, made);
  const total = made.files.reduce((sum, one) => sum + one.size, 0);
  let before = 0;
  for (let index = 0; index < made.files.length; index++) {
    const file = byPath[index]!;
    await sendFile(made.id, index, file, how, (held) => step(before + held, total), stop);
    before += file.size;
  }
  return made.id;
}

/** The files that the server wants, in its order: it leaves out what systems put into folders. */
export function matched(given: readonly Given[], made: Announced): File[] {
  const left = [...given];
  return made.files.map(({ path, size }) => {
    const at = left.findIndex((one) => one.file.size === size && (one.path === path || one.path.endsWith(`/${path}`)));
    const [found] = left.splice(Math.max(at, 0), 1);
    if (!found) throw new Error(path);
    return found.file;
  });
}

async function sendFile(
  id: string,
  index: number,
  file: File,
  how: Sending,
  step: (held: number) => void,
  stop: AbortSignal,
): Promise<void> {
  const one = `${how.base}/${id}`;
  let held = 0;
  let tries = 0;
  let asks = false; // How much is there, before more is sent.
  do {
    stop.throwIfAborted();
    try {
      if (asks) held = (await getJson<{ held: number[] }>(one)).held[index] ?? 0;
      asks = true;
      if (held < file.size || !file.size) held = await sendChunk(`${one}/files/${index}`, file, held, how, stop);
      asks = false;
      tries = 0;
      how.lost?.(false);
    } catch (error) {
      if (!mayGoOn(error) || ++tries > how.tries) throw error;
      how.lost?.(true);
      await new Promise((resolve) => setTimeout(resolve, Math.min(WAIT_MS * tries, MOST_WAIT_MS)));
    }
    step(held);
  } while (held < file.size);
}

async function sendChunk(path: string, file: File, held: number, how: Sending, stop: AbortSignal): Promise<number> {
  const chunk = file.slice(held, held + how.chunkBytes);
  const cut = new AbortController();
  const abort = (): void => cut.abort();
  const timer = how.stallMs ? setTimeout(abort, how.stallMs) : undefined;
  stop.addEventListener("abort", abort);
  try {
    return (await sendBytes<{ held: number }>(`${path}?at=${held}`, chunk, { signal: cut.signal })).held;
  } finally {
    clearTimeout(timer);
    stop.removeEventListener("abort", abort);
  }
}

/** The server was not reached, or still waits for the connection that was lost. */
function mayGoOn(error: unknown): boolean {
  return error instanceof Unreached || (error instanceof Refused && error.status === 409);
}
