// docs/reference/forge-keys.md, made from the table of keys: `npm run keys` writes it, a test compares it.

import { BINDINGS, GROUPS, type Binding } from "./keys";
import { TEXT } from "./text";

export function keysPage(): string {
  const parts = GROUPS.map((group) => section(group, BINDINGS.filter((one) => one.group === group)));
  return [TEXT.keysPage.title, TEXT.keysPage.note, ...parts.filter(Boolean)].join("\n\n") + "\n";
}

// The modes that most keys of a group share stand above its table, others in their row.
function section(group: (typeof GROUPS)[number], lines: readonly Binding[]): string {
  const shown = lines.filter((one) => one.keys.length);
  if (!shown.length) return "";
  const common = commonest(shown.map(modesOf));
  const rows = shown.map((one) => row(one, common));
  return [`## ${TEXT.groups[group]}`, TEXT.keysPage.modes(common), table(rows)].join("\n\n");
}

function table(rows: readonly string[]): string {
  return [`| ${TEXT.keysPage.head.join(" | ")} |`, "|---|---|", ...rows].join("\n");
}

function row(binding: Binding, common: string): string {
  const keys = binding.keys.map((key) => `\`${key}\``).join(", ");
  const modes = modesOf(binding);
  return `| ${keys} | ${binding.title}${modes === common ? "" : ` (${modes})`} |`;
}

function modesOf({ modes }: Binding): string {
  return modes ? modes.map((mode) => TEXT.action[`mode.${mode}`]).join(", ") : TEXT.keysPage.everywhere;
}

function commonest(values: readonly string[]): string {
  const count = (value: string) => values.filter((one) => one === value).length;
  return values.reduce((best, one) => (count(one) > count(best) ? one : best));
}
