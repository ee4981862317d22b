// The script of a shared room: one file, no request.

import "../theme.css";
import "../style_controls.css";
import "./share.css";
import { h } from "../ui/dom";
import { readRoom } from "./data";
import { RoomPage } from "./page";
import { TEXT } from "./text";

const host = document.getElementById("room") ?? document.body.appendChild(h("div", { id: "room" }));

function refuse(why: string, error: unknown): never {
  host.replaceChildren(h("p", { class: "refused", role: "alert" }, why));
  throw error;
}

async function start(): Promise<void> {
  const room = await readRoom().catch((error: unknown) => refuse(TEXT.broken, error));
  let page: RoomPage;
  try {
    page = new RoomPage(host, room);
  } catch (error) {
    return refuse(TEXT.noView, error);
  }
  await page.idle(); // The picture comes first.
  await page.readFloor();
  Object.assign(window, { __room: { page, idle: () => page.idle() } });
}

void start();
