// A capture on its way to the server: in chunks, gone on with where a connection was lost.

import { getJson, sendBytes, sendJson, Unreached } from "./api";
import type { Given } from "./files";

export interface Announced {
  id: string;
  title: string;
  files: { path: string; size: number }[];
}

const TRIES = 6;
const WAIT_MS = 500;

/** Send all files; `step` is told the bytes that are there. Returns the capture's id. */
export async function sendCapture(
  title: string,
  given: readonly Given[],
  chunkBytes: number,
  step: (done: number, total: number) => void,
  stop: AbortSignal,
): Promise<string> {
  const files = given.map(({ path, file }) => ({ path, size: file.size }));
  const made = await sendJson<Announced>("api/start/captures", { title, files });
  const byPath = matched(given, made);
  const total = made.files.reduce((sum, one) => sum + one.size, 0);
  let before = 0;
  for (let index = 0; index < made.files.length; index++) {
    const file = byPath[index]!;
    await sendFile(made.id, index, file, chunkBytes, (held) => step(before + held, total), stop);
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
  chunkBytes: number,
  step: (held: number) => void,
  stop: AbortSignal,
): Promise<void> {
  let held = 0;
  let tries = 0;
  do {
    stop.throwIfAborted();
    try {
      const chunk = file.slice(held, held + chunkBytes);
      const path = `api/start/captures/${id}/files/${index}?at=${held}`;
      held = (await sendBytes<{ held: number }>(path, chunk)).held;
      tries = 0;
    } catch (error) {
      if (!(error instanceof Unreached) || ++tries > TRIES) throw error;
      await new Promise((resolve) => setTimeout(resolve, WAIT_MS * tries));
      held = (await getJson<{ held: number[] }>(`api/start/captures/${id}`)).held[index] ?? 0;
    }
    step(held);
  } while (held < file.size);
}
