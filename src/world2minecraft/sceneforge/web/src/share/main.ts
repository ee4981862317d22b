// The script of a shared room: one file, no request.

import "../theme.css";
import "../style_controls.css";
import "./share.css";
import { h } from "../ui/dom";
import { readRoom } from "./data";
import { RoomPage } from "./page";
import { TEXT } from "./text";

const host = document.getElementById("room") ?? document.body.appendChild(h("div", { id: "room" }));

function refuse(why: string, error: unknown): void {
  host.replaceChildren(h("p", { class: "refused", role: "alert" }, why));
  throw error;
}

void readRoom()
  .catch((error: unknown) => refuse(TEXT.broken, error))
  .then((room) => {
    if (!room) return;
    try {
      const page = new RoomPage(host, room);
      Object.assign(window, { __room: { page, idle: () => page.idle() } });
    } catch (error) {
      refuse(TEXT.noView, error);
    }
  });
