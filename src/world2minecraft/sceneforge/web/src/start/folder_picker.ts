// A dialog that looks for the folder of a game on the machine of the server.

import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { icon } from "../ui/icons";
import { getJson, said, sendJson } from "./api";

interface Listed {
  folder: string;
  parent: string | null;
  folders: { name: string; path: string }[];
  is_game: boolean;
}

/** Let a person choose the folder of a game. Returns the id of the installation, or null. */
export function pickGame(): Promise<string | null> {
  const words = TEXT.folders;
  const place = h("input", { type: "text", "aria-label": words.path, spellcheck: false });
  const list = h("ul", { class: "folder-list" });
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const dialog = h("dialog", { class: "folder-picker", "aria-label": words.title });
  return new Promise((resolve) => {
    let chosen: string | null = null;
    const complain = (text: string): void => {
      trouble.textContent = text;
      trouble.hidden = !text;
    };
    const choose = async (): Promise<void> => {
      try {
        chosen = (await sendJson<{ id: string }>("api/games", { folder: place.value })).id;
        dialog.close();
      } catch (error) {
        complain(said(error));
      }
    };
    const use = plainButton(words.choose, () => void choose(), "button is-main");
    const show = async (path: string): Promise<void> => {
      try {
        const found = await getJson<Listed>(`api/folders?in=${encodeURIComponent(path)}`);
        place.value = found.folder;
        const rows = found.folders.map((one) => folderRow(one.name, () => void show(one.path)));
        const up = found.parent === null ? [] : [folderRow(words.up, () => void show(found.parent!))];
        fill(list, ...up, ...rows);
        use.classList.toggle("is-ready", found.is_game);
        complain("");
      } catch (error) {
        complain(said(error));
      }
    };
    place.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      void show(place.value);
    });
    const cancel = plainButton(TEXT.start.cancel, () => dialog.close());
    fill(dialog, h("h2", {}, words.title), h("p", { class: "note" }, words.lead), place, list, trouble, h("div", { class: "row" }, use, cancel));
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(chosen);
    });
    document.body.append(dialog);
    dialog.showModal();
    void show("");
  });
}

function folderRow(name: string, open: () => void): HTMLElement {
  const button = h("button", { type: "button", class: "folder-row" }, icon("folder"), h("span", {}, name));
  button.addEventListener("click", open);
  return h("li", {}, button);
}
