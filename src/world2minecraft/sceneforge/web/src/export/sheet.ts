// The sheet over the scene for everything that a scene can become: files, worlds, builds.

import { timeOf } from "../jobs/progress";
import { getJson, said, sendJson } from "../start/api";
import { pickGame } from "../start/folder_picker";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { icon } from "../ui/icons";
import { registerExport, registerStagePart, type App } from "../ui/slots";
import type { JobState } from "../wire";

interface Told {
  forms: { id: string; group: string; built: boolean }[];
  scales: number[];
  scale: number;
  styles: string[];
  versions: string[];
  version: string;
  games: { id: string; name: string; version: string | null }[];
  worlds: { id: string; name: string; game: string }[];
}

interface Made {
  id: string;
  file: string;
  bytes: number;
  lost: [string, number][];
}

type Fields = Record<string, unknown>;

export function registerExports(): void {
  let sheet: ExportSheet | null = null;
  registerStagePart({ id: "export-sheet", mount: (_, app) => void (sheet = new ExportSheet(app)) });
  registerExport({ id: "sheet", label: TEXT.exports.menu, run: () => void sheet?.open() });
}

class ExportSheet {
  private readonly body = h("div", { class: "export-body" });
  private readonly page: HTMLElement;
  private told: Told | null = null;
  private readonly scale = h("select", { data: { field: "export-scale" } });
  private readonly style = h("select", { data: { field: "export-style" } });
  private readonly version = h("select", { data: { field: "export-version" } });

  constructor(private readonly app: App) {
    const words = TEXT.exports;
    const close = h("button", { type: "button", class: "button icon-only", "aria-label": words.close, title: words.close }, icon("close"));
    close.addEventListener("click", () => this.close());
    this.page = h(
      "section",
      { class: "sheet export", role: "region", "aria-label": words.title, tabindex: "-1", hidden: true },
      h("div", { class: "sheet-head" }, h("h2", {}, words.title), h("span", { class: "note" }, words.lead), close),
      this.body,
    );
    this.page.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      this.close();
    });
    app.stage.append(this.page);
  }

  async open(): Promise<void> {
    try {
      this.told = await getJson<Told>("api/exports");
    } catch (error) {
      this.app.toast(said(error), "error");
      return;
    }
    this.fill(this.told);
    this.page.hidden = false;
    this.page.focus();
  }

  private close(): void {
    this.page.hidden = true;
    this.app.canvas.focus();
  }

  private fill(told: Told): void {
    const words = TEXT.exports;
    const options = (node: HTMLSelectElement, values: readonly (string | number)[], names: (value: string) => string, chosen: string | number): void => {
      fill(node, ...values.map((value) => h("option", { value: String(value) }, names(String(value)))));
      node.value = String(chosen);
    };
    options(this.scale, told.scales, (value) => value, told.scale);
    options(this.style, told.styles, (value) => TEXT.start.styles[value] ?? value, told.styles[0] ?? "");
    options(this.version, told.versions, (value) => value, told.version);
    const groups = ["game", "3d", "data"].map((group) =>
      h(
        "section",
        { class: "export-group" },
        h("h3", {}, words.groups[group]),
        h("ul", {}, ...told.forms.filter((one) => one.group === group).map((one) => this.formRow(one.id))),
      ),
    );
    fill(
      this.body,
      h(
        "div",
        { class: "export-choices" },
        h("label", {}, h("span", {}, TEXT.start.size), this.scale),
        h("label", {}, h("span", {}, TEXT.start.style), this.style),
        h("label", {}, h("span", {}, words.version), this.version),
      ),
      h("div", { class: "export-places" }, this.installPart(told), this.worldPart(told), this.serverPart()),
      h("div", { class: "export-groups" }, ...groups),
    );
  }

  private choice(): Fields {
    return { blocks_per_metre: Number(this.scale.value), style: this.style.value, mc_version: this.version.value };
  }

  private formRow(id: string): HTMLElement {
    const words = TEXT.exports;
    const [name, hint] = words.forms[id] ?? [id, ""];
    const note = h("p", { class: "note", "aria-live": "polite" });
    const button = plainButton(words.download, () => {
      void this.run("api/exports", { form: id, ...this.choice() }, note, (result) => this.saveFile(result as Made, note));
    });
    button.dataset.export = id;
    button.setAttribute("aria-label", `${words.download}: ${name}`);
    return h("li", { class: "export-row" }, h("div", {}, h("strong", {}, name), hint && h("span", { class: "note" }, hint), note), button);
  }

  private saveFile(made: Made, note: HTMLElement): void {
    const words = TEXT.exports;
    const link = h("a", { href: `api/exports/files/${made.id}`, download: made.file, hidden: true });
    this.page.append(link);
    link.click();
    link.remove();
    const size = TEXT.start.megabytes(made.bytes / 2 ** 20);
    const lost = made.lost.map(([what, count]) => `${count.toLocaleString("en")} ${what}`).join(", ");
    fill(note, `${words.made(made.file, size)}; ${lost ? words.lost(lost) : words.nothingLost}`);
  }

  private installPart(told: Told): HTMLElement {
    const words = TEXT.exports;
    const game = h("select", { "aria-label": words.game }, ...told.games.map((one) => h("option", { value: one.id }, one.name)));
    const name = h("input", { type: "text", maxlength: 60, "aria-label": words.name, value: this.app.store.get().scene?.name ?? "" });
    const done = (result: unknown): string => {
      const made = result as { name: string; game: string; note: string };
      return [words.installed(made.name), words.steps(made.game, made.name), made.note].filter(Boolean).join(". ");
    };
    const fields = (): Fields => ({ game: game.value, name: name.value });
    if (!told.games.length) return this.findGamePart();
    return this.part("install", words.install, words.installLead, [["", game], [words.name, name]], "api/install", fields, done);
  }

  private findGamePart(): HTMLElement {
    const words = TEXT.exports;
    const find = plainButton(words.findGame, () => {
      void pickGame().then((id) => (id ? this.open() : undefined));
    });
    find.dataset.do = "find-game";
    return h("details", { class: "export-place", open: true }, h("summary", {}, words.install), h("p", { class: "note" }, words.noGames), find);
  }

  private worldPart(told: Told): HTMLElement {
    const words = TEXT.exports;
    const world = h("select", { "aria-label": words.worldName }, ...told.worlds.map((one) => h("option", { value: one.id }, `${one.name} · ${one.game}`)));
    const place = placeFields();
    const fields = (): Fields => ({ world: world.value, ...place.value() });
    const done = (result: unknown): string => words.builtWorld((result as { blocks: number }).blocks.toLocaleString("en"));
    return this.part("world", words.world, told.worlds.length ? words.worldLead : words.noWorlds, told.worlds.length ? [["", world], ...place.rows] : [], "api/build/world", fields, done);
  }

  private serverPart(): HTMLElement {
    const words = TEXT.exports;
    const address = h("input", { type: "text", value: "localhost:25575", "aria-label": words.address });
    const password = h("input", { type: "password", autocomplete: "off", "aria-label": words.password });
    const place = placeFields();
    const fields = (): Fields => ({ address: address.value, password: password.value, ...place.value() });
    const done = (result: unknown): string => words.builtServer((result as { commands: number }).commands.toLocaleString("en"));
    return this.part("server", words.server, words.serverLead, [[words.address, address], [words.password, password], ...place.rows], "api/build/server", fields, done);
  }

  private part(
    id: string,
    title: string,
    lead: string,
    rows: [string, HTMLElement][],
    path: string,
    fields: () => Fields,
    done: (result: unknown) => string,
  ): HTMLElement {
    const note = h("p", { class: "note", "aria-live": "polite" });
    const label = id === "install" ? title : TEXT.exports.buildNow;
    const go = plainButton(label, () => {
      void this.run(path, { ...fields(), ...this.choice() }, note, (result) => fill(note, done(result)));
    }, id === "install" ? "button is-main" : "button");
    go.dataset.place = id;
    return h(
      "details",
      { class: "export-place", open: id === "install" },
      h("summary", {}, title),
      h("p", { class: "note" }, lead),
      ...rows.map(([name, field]) => h("label", { class: "export-field" }, name && h("span", {}, name), field)),
      rows.length > 0 && go,
      note,
    );
  }

  /** Begin a job and say in `note` how far it is, until it has ended. */
  private async run(path: string, told: Fields, note: HTMLElement, done: (result: unknown) => void): Promise<void> {
    const { connection } = this.app;
    try {
      fill(note, "…");
      const { job } = await sendJson<{ job: string }>(path, told);
      const stop = connection.onJob((state) => hear(state));
      let ended = false; // Its end may be heard of twice: by the socket, and by asking.
      const hear = (state: JobState): void => {
        if (state.id !== job || ended) return;
        if (state.state === "running") {
          const left = state.left_s === null || !state.stage ? "" : `, ${TEXT.start.left(timeOf(state.left_s))}`;
          fill(note, `${TEXT.start.stages[state.stage] ?? "…"}${left}`);
          return;
        }
        ended = true;
        stop();
        note.classList.toggle("is-bad", state.state === "failed");
        if (state.state === "done") done(state.result);
        else fill(note, state.state === "failed" ? state.note : TEXT.start.cancelled);
      };
      const now = await getJson<JobState[]>("api/jobs"); // It may have ended before it was heard of.
      const found = now.find((one) => one.id === job);
      if (found && found.state !== "running") hear(found);
    } catch (error) {
      fill(note, said(error));
    }
  }
}

function placeFields(): { rows: [string, HTMLElement][]; value(): Fields } {
  const words = TEXT.exports;
  const at = h("input", { type: "text", value: "0 64 0", "aria-label": words.at, title: words.atHint });
  const turns = h("select", { "aria-label": words.turns }, ...[0, 1, 2, 3].map((one) => h("option", { value: String(one) }, `${one * 90}°`)));
  return {
    rows: [[words.at, at], [words.turns, turns]],
    value: () => ({ at: at.value.trim().split(/[\s,]+/).map(Number), turns: Number(turns.value) }),
  };
}
