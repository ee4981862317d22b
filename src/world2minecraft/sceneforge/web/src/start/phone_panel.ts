// The code that lets a phone in, where w2m forge --phone serves a page for it.

import { timeOf } from "../jobs/progress";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { icon } from "../ui/icons";
import { getJson, said, sendJson } from "./api";
import type { PhoneCode } from "./told";

const POLL_MS = 2000;

/** The panel. It looks again and again while it is on the page; `sent` is called when what phones sent changes. */
export function phonePanel(first: PhoneCode, sent: () => void): HTMLElement {
  const node = h("section", { class: "phone-panel", "aria-label": TEXT.start.phone.title });
  let shown = "";
  let captures = JSON.stringify(first.captures);

  const show = (told: PhoneCode): void => {
    const now = JSON.stringify(told.captures);
    if (now !== captures) sent();
    captures = now;
    const left = told.link ? TEXT.start.phone.left(timeOf(told.left_s)) : "";
    const state = JSON.stringify([told.code, told.phones, left]);
    if (state !== shown) fill(node, ...contents(told, left, renew));
    shown = state;
  };
  const renew = (): void => {
    sendJson<PhoneCode>("api/start/phone").then(show, (error) => fill(node, h("p", { class: "trouble" }, said(error))));
  };
  const look = (): void => {
    if (!node.isConnected) return;
    getJson<PhoneCode>("api/start/phone").then(show, () => undefined);
    setTimeout(look, POLL_MS);
  };
  show(first);
  setTimeout(look, POLL_MS);
  return node;
}

function contents(told: PhoneCode, left: string, renew: () => void): HTMLElement[] {
  const words = TEXT.start.phone;
  const title = h("strong", {}, words.title);
  const button = plainButton(words.renew, renew, told.link ? "button is-quiet" : "button is-main");
  button.dataset.do = "phone-code";
  if (!told.link) {
    const line = told.phones ? words.connected(told.phones) : words.old;
    return [h("div", { class: "phone-mark" }, icon(told.phones ? "check" : "scan")), title, h("p", { class: "note" }, line), button];
  }
  const code = h("img", { class: "phone-code", src: told.code, alt: words.alt, width: 164, height: 164 });
  const link = h("p", { class: "phone-link" }, told.link);
  return [code, title, h("p", { class: "note" }, words.lead), link, h("div", { class: "row" }, h("span", { class: "note" }, left), button)];
}
