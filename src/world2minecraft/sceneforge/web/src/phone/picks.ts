// What a person took or chose: photos, or one video, with names of their own.

import type { Given } from "../start/files";
import { TEXT } from "./text";

export interface Limits {
  most_bytes: number;
  most_photos: number;
  photo_suffixes: string[];
  video_suffixes: string[];
}

export interface Picks {
  kind: "none" | "photos" | "video";
  files: File[];
}

export const NOTHING: Picks = { kind: "none", files: [] };

/** Add files. Raises an Error that says what is wrong with them; then nothing was added. */
export function added(picks: Picks, more: readonly File[], limits: Limits): Picks {
  let { kind, files } = picks;
  for (const file of more) {
    const suffix = suffixOf(file);
    const isVideo = limits.video_suffixes.includes(suffix);
    if (!isVideo && !limits.photo_suffixes.includes(suffix)) throw new Error(TEXT.wrong.kind(file.name));
    if (!file.size) throw new Error(TEXT.wrong.empty(file.name));
    if (isVideo ? kind !== "none" : kind === "video") throw new Error(TEXT.wrong.mixed);
    kind = isVideo ? "video" : "photos";
    files = [...files, file];
  }
  if (files.length > limits.most_photos) throw new Error(TEXT.wrong.tooMany(limits.most_photos));
  const size = bytesOf(files);
  if (size > limits.most_bytes) throw new Error(TEXT.wrong.tooLarge(TEXT.size(size), TEXT.size(limits.most_bytes)));
  return { kind, files };
}

/** The files under names that differ: phones call every photo image.jpg. */
export function named(picks: Picks): Given[] {
  return picks.files.map((file, at) => ({ path: `${picks.kind === "video" ? "video" : String(at + 1).padStart(4, "0")}${suffixOf(file)}`, file }));
}

export function bytesOf(files: readonly File[]): number {
  return files.reduce((sum, one) => sum + one.size, 0);
}

const BY_TYPE: Record<string, string> = { "image/jpeg": ".jpg", "image/png": ".png", "image/webp": ".webp", "image/heic": ".heic", "image/heif": ".heif", "video/mp4": ".mp4", "video/quicktime": ".mov", "video/webm": ".webm" };

/** The suffix in lower case; by the type where a phone gives a file no suffix. */
function suffixOf(file: File): string {
  return /\.[a-z0-9]+$/i.exec(file.name)?.[0].toLowerCase() ?? BY_TYPE[file.type] ?? "";
}
