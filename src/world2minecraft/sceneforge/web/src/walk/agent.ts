// A model that walks: it decides on the server, a few moves at a time, and Walk plays them.

import type { Vec3 } from "../wire";
import { shortWay } from "./led";
import { yawTo } from "./route";
import type { Walker } from "./walker";

const PACE_M_S = 1.2;
const TURN_DEG_S = 120;

/** Where an agent stands, in metres of the room, and a point ahead of its feet. */
export interface AgentStance {
  feet_m: Vec3;
  ahead_m: Vec3;
}

/** POST /api/agents/step */
export interface AgentStep {
  stances: AgentStance[];
  thought: string;
  end: "" | "stopped" | "gave up" | "out of steps";
  steps: number;
  goal: { id: number; name: string; away_m: number } | null; // of what the sentence names
  usd: number | null; // null: the price is unknown
  calls: number;
}

export async function configuredAgents(): Promise<string[]> {
  const answer = await fetch("api/agents");
  return answer.ok ? ((await answer.json()) as { agents: string[] }).agents : [];
}

/** A server by its host, a known service by its name. */
export function agentTitle(agent: string): string {
  return agent.replace(/^https?:\/\/([^/]+).*$/, "$1");
}

export async function post<T>(what: string, fields: object): Promise<T> {
  const headers = { "Content-Type": "application/json" };
  const answer = await fetch(`api/agents/${what}`, { method: "POST", headers, body: JSON.stringify(fields) });
  const told = (await answer.json()) as T & { error?: string };
  if (!answer.ok) throw new Error(told.error);
  return told;
}

/** The moves of one decision, at a pace that one can follow. */
export class Moves {
  private next = 0;
  private readonly stands: { place: Vec3; yawDeg: number }[];

  constructor(walker: Walker, stances: readonly AgentStance[]) {
    this.stands = stances.map(({ feet_m, ahead_m }) => {
      const place = walker.blocksOf(feet_m);
      return { place, yawDeg: yawTo(place, walker.blocksOf(ahead_m)) };
    });
  }

  pass(walker: Walker, milliseconds: number): boolean {
    for (let left = milliseconds / 1000; this.next < this.stands.length && left > 0; ) {
      const { place, yawDeg } = this.stands[this.next]!;
      const from = walker.body.position;
      const away = Math.hypot(...place.map((v, i) => v - from[i]!)) / walker.scale;
      const turn = shortWay(walker.yawDeg, yawDeg);
      const needs = Math.max(away / PACE_M_S, Math.abs(turn) / TURN_DEG_S);
      const share = needs > left ? left / needs : 1;
      const at = from.map((v, i) => v + (place[i]! - v) * share) as Vec3;
      walker.put(at, walker.yawDeg + turn * share, walker.pitchDeg * (1 - share)); // It looks level.
      left -= needs;
      if (share === 1) this.next += 1;
    }
    return this.next === this.stands.length;
  }
}

/** Standing still while the agent decides. */
export const STANDING = { pass: (): boolean => false };
