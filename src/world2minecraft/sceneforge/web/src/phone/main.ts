// The script of the phone page, which w2m forge --phone serves on the local network.

import "../theme.css";
import "./phone.css";
import { followTheme } from "../theme";
import { h } from "../ui/dom";
import { PhonePage } from "./page";

followTheme(() => undefined);
void new PhonePage(document.getElementById("phone") ?? document.body.appendChild(h("main", { id: "phone" }))).start();
