// "Go to the lamp" in the editor: the planner on the server finds the way, and Walk leads along it.
// Where a model is configured, it can walk instead.

import { TEXT } from "../text";
import { h } from "../ui/dom";
import type { App } from "../ui/slots";
import type { Vec3 } from "../wire";
import { agentTitle, configuredAgents, Moves, post, STANDING, type AgentStep } from "./agent";
import { GoBox, nearNames } from "./go_box";
import { Led } from "./led";
import type { Walking } from "./mode";
import { Route } from "./route";

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
    if (box.agent) {
      await letWalk(box.agent, text, () => mine === asked && walking.isOn).catch((error: unknown) => {
        walking.lead(null);
        box.say(error instanceof Error ? error.message : String(error));
      });
      return;
    }
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
    walking.lead({
      way: (walker) => new Led(new Route(corners_m.map((corner) => walker.blocksOf(corner))), walker.blocksOf(thing.center_m), walker.scale),
      arrived: () => box.say(words.arrived(thing.name)),
      broken: () => box.say(""),
    });
  };
  /** Let a model walk, a decision at a time, until it stops or the person walks on. */
  const letWalk = async (agent: string, to: string, isMine: () => boolean): Promise<void> => {
    const { walker, size } = walking;
    if (!walker) return;
    const title = agentTitle(agent);
    let isBroken = false;
    const broken = (): void => {
      isBroken = true;
      box.say("");
    };
    const stand = (): void => walking.lead({ way: () => STANDING, arrived: () => undefined, broken });
    const goesOn = (): boolean => isMine() && !isBroken;
    stand();
    box.say(words.deciding(title, 1, ""));
    const start = { agent, to, feet_m: walker.feet, look_m: walker.pose.forward, blocks_per_metre: size };
    const { walk } = await post<{ walk: number }>("walk", start);
    for (let step = 2; goesOn(); step += 1) {
      const decided = await post<AgentStep>("step", { walk });
      if (!goesOn()) return;
      const cost = words.cost(decided.usd, decided.calls);
      const thought = decided.thought ? words.thought(decided.thought) : "";
      await new Promise<void>((done) => {
        const stop = (): void => (broken(), done());
        walking.lead({ way: (one) => new Moves(one, decided.stances), arrived: done, broken: stop });
        box.say(words.deciding(title, step, cost) + thought);
      });
      if (!goesOn()) return;
      if (decided.end) {
        const { goal } = decided;
        if (goal) app.selection.objects([goal.id]);
        box.say(words.agentEnd[decided.end](title) + (goal ? words.agentGoal(goal.name, goal.away_m) : "") + `${cost}.` + thought);
        return;
      }
      stand();
    }
  };

  void configuredAgents().then((names) => box.offerAgents(names, agentTitle), () => undefined);
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
