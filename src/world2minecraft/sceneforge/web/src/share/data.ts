// What a shared page carries: one packet, compressed, in base64 (sceneforge/share/room_data.py), and
// photos beside it.

import { expanded } from "../build/compact";
import type { BlockMesh, DrawnFacts } from "../build/mesh";
import { Packet } from "../build/packet";
import type { Frame } from "../photos/place";
import type { Vec3 } from "../wire";

export interface Thing {
  id: number;
  name: string;
  low_m: Vec3;
  high_m: Vec3;
  size_m: Vec3;
  way: number; // its row of the ways; -1 where one cannot walk to it
}

export interface RoomFacts extends DrawnFacts {
  title: string;
  size_m: Vec3 | null; // of the room, where it is known
  can_walk: boolean;
  azimuth: number; // radians, from where most is seen
  things: Thing[];
  phrases: Record<string, number[]>; // what people may call things, in small letters
  photos: Frame[];
}

export interface RoomData {
  facts: RoomFacts;
  mesh: BlockMesh;
}

export async function readRoom(): Promise<RoomData> {
  const packet = await readPacket("room-data");
  return { facts: packet.told as unknown as RoomFacts, mesh: expanded(packet) };
}

/** What stops a walker, and the ways of the planner: larger, and not needed for the first picture. */
export function readFloor(): Promise<Packet> {
  return readPacket("floor-data");
}

async function readPacket(id: string): Promise<Packet> {
  const stream = new Blob([fromBase64(blockText(id))]).stream().pipeThrough(new DecompressionStream("deflate"));
  return Packet.read(await new Response(stream).arrayBuffer(), "W2MS");
}

/** The address of a photo of the page: its bytes themselves. */
export function photoAddress(n: number): string {
  return `data:image/jpeg;base64,${blockText(`photo-${n}`)}`;
}

function blockText(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const raw = atob(text.trim());
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}
