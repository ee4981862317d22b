// What the server tells the start page; server/start_routes.py says the same.

export interface Doubt {
  level: "ok" | "warn" | "stop";
  text: string;
  advice: string;
}

export interface Survey {
  kind: "frames" | "plan";
  called: string;
  lines: [string, string][];
  doubts: Doubt[];
  can_start: boolean;
  about_s: number;
  has_scale: boolean;
}

export interface CaptureTold {
  id: string;
  title: string;
  files: number;
  bytes: number;
  elsewhere: string;
  complete: boolean;
  has_room: boolean;
  job: string | null;
  survey: Survey | null;
}

export interface StartTold {
  home: string;
  captures: CaptureTold[];
  recent: { id: string; name: string; folder: string; has_picture: boolean }[];
  demos: string[];
  most_bytes: number;
  chunk_bytes: number;
  scales: number[];
  scale: number;
  styles: string[];
  known: Record<string, [number, number]>;
  phone: PhoneCode | null; // where a phone page is served
  wanted: string | null; // the capture that the server was started with
}

export interface PhoneCode {
  link: string; // empty once it is used, or too old
  code: string; // its picture, as a data URI
  left_s: number;
  phones: number;
  captures: [string, boolean, boolean, boolean][]; // id, whether complete, running, a room
}

export interface Choice {
  blocks_per_metre: number;
  style: string;
  known: [string, number] | null;
}
