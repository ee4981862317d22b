// docs/reference/forge-keys.md, made from the table of keys: `npm run keys` writes it, a test compares it.

import { BINDINGS, GROUPS, type Binding } from "./keys";
import { TEXT } from "./text";

export function keysPage(): string {
  const parts = GROUPS.map((group) => section(group, BINDINGS.filter((one) => one.group === group)));
  return [TEXT.keysPage.title, TEXT.keysPage.note, ...parts.filter(Boolean)].join("\n\n") + "\n";
}

function section(group: (typeof GROUPS)[number], lines: readonly Binding[]): string {
  const rows = lines.filter((one) => one.keys.length).map(row);
  if (!rows.length) return "";
  return [`## ${TEXT.groups[group]}`, "", `| ${TEXT.keysPage.head.join(" | ")} |`, "|---|---|---|", ...rows].join("\n");
}

function row({ keys, title, modes }: Binding): string {
  const shown = keys.map((key) => `\`${key}\``).join(", ");
  const where = modes ? modes.map((mode) => TEXT.action[`mode.${mode}`]).join(", ") : TEXT.keysPage.everywhere;
  return `| ${shown} | ${title} | ${where} |`;
}
