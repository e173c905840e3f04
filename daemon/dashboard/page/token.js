// SPDX-License-Identifier: Apache-2.0
// On the robot itself the page is read without the token; whoever commands is asked for it (docs/api.md).

import { command } from "./commands.js";

/// Whether commands are refused for want of the token. A status changes nothing.
export async function is_locked() {
  return (await command({ command: "status" })).is_locked === true;
}

/// Asks in the row. The right token is kept in a cookie that no script sees, and the page begins anew.
export function ask_token(row) {
  const field = document.createElement("input");
  field.type = "password";
  field.autocomplete = "off";
  field.setAttribute("aria-label", "Token");
  const enter = () => location.assign(`/?token=${encodeURIComponent(field.value)}`);
  field.addEventListener("keydown", (event) => { if (event.key === "Enter") enter(); });
  row.ask("Commands need the token of this daemon.", [["Unlock", enter]]);
  row.text.append(" ", field);
  field.focus();
}
