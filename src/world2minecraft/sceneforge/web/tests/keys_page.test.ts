import { expect, test } from "vitest";

import { keysPage } from "../src/keys_page";

test("docs/reference/forge-keys.md is what the table says (npm run keys writes it)", async () => {
  await expect(keysPage()).toMatchFileSnapshot("../../../../../docs/reference/forge-keys.md");
});
