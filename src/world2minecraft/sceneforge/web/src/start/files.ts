// What a person dropped or chose: files with their paths, whatever folders they lie in.

import { TEXT } from "../text";

export interface Given {
  path: string;
  file: File;
}

const MOST_FILES = 25_000; // A little over what the server takes, so that it says why.

/** All files of a drop; folders are walked through. Call it within the event. */
export async function filesOfDrop(data: DataTransfer): Promise<Given[]> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry()).filter((one) => one !== null);
  if (!entries.length) return [...data.files].map((file) => ({ path: file.name, file }));
  const found: Given[] = [];
  for (const entry of entries) await walk(entry, found);
  return found;
}

export function filesOfInput(input: HTMLInputElement): Given[] {
  return [...(input.files ?? [])].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
}

const PICTURES = /\.(jpe?g|png|heic|heif|webp|tiff?)$/i;

/** The title of a capture: its folder or only file, else what it consists of. */
export function titleOf(given: readonly Given[]): string {
  const tops = new Set(given.map((one) => one.path.split("/")[0] ?? ""));
  const [top] = tops;
  if (tops.size === 1 && top) return given.length === 1 ? top.replace(/\.[^.]+$/, "") : top;
  const photos = given.filter((one) => PICTURES.test(one.path)).length;
  return TEXT.start.untitled(photos === given.length ? "photos" : "files", given.length);
}

/** What is uploaded, such as "kitchen: 40 files". */
export function contentsOf(given: readonly Given[]): string {
  const title = titleOf(given);
  const count = TEXT.start.countOf(given.length);
  return title.includes(count) || given.length === 1 ? (given.length === 1 ? given[0]!.path : title) : `${title}: ${count}`;
}

async function walk(entry: FileSystemEntry, found: Given[]): Promise<void> {
  if (found.length > MOST_FILES) return;
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => {
      (entry as FileSystemFileEntry).file(resolve, reject);
    });
    found.push({ path: entry.fullPath.replace(/^\//, ""), file });
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => {
      reader.readEntries(resolve, reject);
    });
    if (!some.length) return;
    for (const one of some) await walk(one, found);
  }
}
