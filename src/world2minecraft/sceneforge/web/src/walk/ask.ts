// "Go to the lamp" in the editor: the planner on the server finds the way, and Walk leads along it.

import { TEXT } from "../text";
import { h } from "../ui/dom";
import type { App } from "../ui/slots";
import type { Vec3 } from "../wire";
import { GoBox, nearNames } from "./go_box";
import type { Walking } from "./mode";

/** GET /api/way */
export interface Way {
  thing: { id: number; name: string; center_m: Vec3 } | null;
  subject?: string; // of a sentence that names nothing here
  near?: string[];
  of?: number; // how many things have this name
  away_m?: number | null;
  corners_m?: Vec3[] | null; // null: no way
}

export function mountAsk(host: HTMLElement, app: App, walking: Walking): void {
  const words = TEXT.walk.ask;
  const box = new GoBox(words, (text) => void ask(text));
  const node = h("div", { class: "walk-ask glass", hidden: true }, box.node);
  host.append(node);
  let asked = 0;

  const ask = async (text: string): Promise<void> => {
    const { walker } = walking;
    if (!text) return box.say(words.nothing);
    if (!walker) return box.say(words.soon);
    const mine = ++asked;
    walking.lead(null);
    box.say(words.looking);
    const answer = await wayTo(text, walker.feet, walking.size).catch((error: unknown) => String(error instanceof Error ? error.message : error));
    if (mine !== asked || !walking.isOn) return;
    if (typeof answer === "string") box.say(answer);
    else answerWith(answer);
  };
  const answerWith = ({ thing, subject, near, of, away_m, corners_m }: Way): void => {
    if (!thing) return box.say(words.unknown(subject ?? ""), near?.length ? nearNames(near, (name) => void ask(name)) : null);
    if (!corners_m) return box.say(words.noWay(thing.name));
    app.selection.objects([thing.id]);
    box.say(words.walking(thing.name, away_m ?? 0, of ?? 1));
    walking.lead({ corners_m, goal_m: thing.center_m, arrived: () => box.say(words.arrived(thing.name)), broken: () => box.say("") });
  };

  app.store.watch(["mode", "objects"], ({ mode, objects }) => {
    node.hidden = mode !== "walk";
    if (mode === "walk") box.offer([...objects.values()].map(({ title }) => title).sort());
    else box.say("");
  });
  app.actions.on("walk.ask", {
    run: () => {
      app.store.set({ mode: "walk" });
      box.focus();
    },
    why: () => (app.store.get().scene ? "" : TEXT.why.noScene),
  });
}

async function wayTo(to: string, feet: Vec3, size: number): Promise<Way> {
  const query = new URLSearchParams({ to, feet_m: feet.map((value) => value.toFixed(3)).join(), blocks_per_metre: String(size) });
  const answer = await fetch(`api/way?${query.toString()}`);
  const told = (await answer.json()) as Way & { error?: string };
  if (!answer.ok) throw new Error(told.error);
  return told;
}
