// SPDX-License-Identifier: Apache-2.0
// How many cells of which kind a change concerns, in words.

const whole = (number) => Math.round(number).toLocaleString("en");

/// "1,024 occupied, 3 forgotten"; empty where there are none.
export function cell_text({ occupied = 0, free = 0, forgotten = 0 }) {
  const kinds = [[occupied, "occupied"], [free, "free"], [forgotten, "forgotten"]];
  return kinds.filter(([count]) => count).map(([count, kind]) => `${whole(count)} ${kind}`).join(", ");
}
