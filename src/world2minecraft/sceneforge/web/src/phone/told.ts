// What the phone page asks of the server; server/phone_routes.py says the same.

import { getJson, sendJson } from "../start/api";
import type { JobState } from "../wire";
import type { Limits } from "./picks";

export const CAPTURES = "api/phone/captures";

export interface CaptureTold {
  id: string;
  title: string;
  complete: boolean;
  has_room: boolean;
  has_page: boolean;
  job: JobState | null;
}

export interface PhoneTold extends Limits {
  chunk_bytes: number;
  capture: CaptureTold | null;
}

/** Exchange the token of the address for a cookie, and take it out of the address. */
export async function pair(): Promise<void> {
  const token = location.hash.slice(1);
  if (!token) return;
  history.replaceState(null, "", location.pathname);
  await sendJson("api/phone/pair", { token });
}

export function overview(): Promise<PhoneTold> {
  return getJson<PhoneTold>("api/phone");
}

export function capture(id: string): Promise<CaptureTold> {
  return getJson<CaptureTold>(`${CAPTURES}/${id}`);
}

export async function build(id: string): Promise<void> {
  await sendJson(`${CAPTURES}/${id}/build`);
}

export async function cancel(id: string): Promise<void> {
  await sendJson(`${CAPTURES}/${id}/cancel`);
}
