// Which thing a sentence names: as navigation/running/sentence_goals.py, the phrase that ends last.

import type { Thing } from "./data";

export type Found = { thing: Thing; of: number } | { near: string[] };

const MOST_NEAR = 4;
const LIKE = 0.34; // of the letters may differ
const SMALL_TALK = /^(?:please |can you |could you )*(?:(?:go|walk|run|fly|come|lead me|take me|show me|where is|where's|find)\b\s*)?(?:over )?(?:to )?(?:the |a |an |my )?/;

/**
 * The thing that a sentence names, the nearest of several, or names that are like what it says.
 * `away` is how far a thing is to walk.
 */
export function findThing(sentence: string, phrases: Record<string, number[]>, things: readonly Thing[], away: (thing: Thing) => number): Found {
  const text = plain(sentence);
  let best: { end: number; start: number; phrase: string } | null = null;
  for (const phrase of Object.keys(phrases)) {
    for (let start = text.indexOf(phrase); start >= 0; start = text.indexOf(phrase, start + 1)) {
      const end = start + phrase.length;
      if (isLetter(text[start - 1]) || isLetter(text[end])) continue;
      if (!best || end > best.end || (end === best.end && start < best.start)) best = { end, start, phrase };
    }
  }
  const ids = best ? phrases[best.phrase]! : [];
  const named = things.filter((thing) => ids.includes(thing.id)).sort((a, b) => away(a) - away(b));
  return named[0] ? { thing: named[0], of: named.length } : { near: alike(text, phrases, things) };
}

/** What a sentence is about: "where is the fridge?" is about a fridge. */
export function subjectOf(sentence: string): string {
  return plain(sentence).replace(SMALL_TALK, "") || sentence;
}

function plain(sentence: string): string {
  return sentence.toLowerCase().replace(/[^\p{L}\p{N}' -]+/gu, " ").replace(/\s+/g, " ").trim();
}

function isLetter(mark: string | undefined): boolean {
  return mark !== undefined && /[\p{L}\p{N}_]/u.test(mark);
}

/** Names whose words are like those of a text, else some names at all. */
function alike(text: string, phrases: Record<string, number[]>, things: readonly Thing[]): string[] {
  const wanted = subjectOf(text).slice(0, 40);
  const known = new Map(things.map((thing) => [thing.id, thing.name]));
  const scored = Object.entries(phrases).flatMap(([phrase, ids]) => {
    const names = ids.map((id) => known.get(id)).filter((name) => name !== undefined);
    return names.map((name) => ({ name, far: distance(wanted, phrase) / Math.max(wanted.length, phrase.length, 1) }));
  });
  const near = scored.filter(({ far }) => wanted && far <= LIKE).sort((a, b) => a.far - b.far);
  const short = [...things].sort((a, b) => words(a.name) - words(b.name)); // What a person would say.
  const names = (near.length ? near : short).map(({ name }) => name);
  return [...new Set(names)].slice(0, MOST_NEAR);
}

function words(text: string): number {
  return text.split(" ").length;
}

/** How many letters must be changed, added or taken to get from one word to another. */
export function distance(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, i) => i);
  for (let i = 1; i <= a.length; i++) {
    const next = [i];
    for (let k = 1; k <= b.length; k++) {
      next.push(Math.min(row[k]! + 1, next[k - 1]! + 1, row[k - 1]! + Number(a[i - 1] !== b[k - 1])));
    }
    row = next;
  }
  return row[b.length]!;
}
