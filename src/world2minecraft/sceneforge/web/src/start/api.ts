// What the start page, photos, comparing and exports ask of the server.

import { TEXT } from "../text";

export async function getJson<T>(path: string): Promise<T> {
  return answer<T>(await reached(fetch(path)));
}

export async function sendJson<T>(path: string, body: unknown = {}, method = "POST"): Promise<T> {
  const headers = { "Content-Type": "application/json" };
  return answer<T>(await reached(fetch(path, { method, headers, body: JSON.stringify(body) })));
}

export async function sendBytes<T>(path: string, body: Blob, how: { method?: string; signal?: AbortSignal } = {}): Promise<T> {
  return answer<T>(await reached(fetch(path, { method: "PUT", body, ...how })));
}

export async function forget(path: string): Promise<void> {
  await answer(await reached(fetch(path, { method: "DELETE" })));
}

/** The server could not be reached: worth another try. */
export class Unreached extends Error {}

/** The server answered, and says why it will not. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    why: string,
  ) {
    super(why);
  }
}

async function reached(asked: Promise<Response>): Promise<Response> {
  try {
    return await asked;
  } catch {
    throw new Unreached(TEXT.error.offline);
  }
}

async function answer<T>(response: Response): Promise<T> {
  const told = (await response.json().catch(() => ({}))) as T & { error?: string };
  if (!response.ok) throw new Refused(response.status, told.error ?? `${response.status} ${response.statusText}`);
  return told;
}

export function said(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
