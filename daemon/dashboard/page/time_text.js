// SPDX-License-Identifier: Apache-2.0
// Times (Unix s) as a person reads them: local, 24 hours, the same in every language.

const two = (number) => String(number).padStart(2, "0");

/// "09:05:30"
export function clock(time) {
  const date = new Date(1000 * time);
  return [date.getHours(), date.getMinutes(), date.getSeconds()].map(two).join(":");
}

/// "40 s", "3 min", "2 h"
export function span_of(passed_s) {
  const span = Math.max(0, passed_s);
  if (span < 90) return `${Math.round(span)} s`;
  return span < 5400 ? `${Math.round(span / 60)} min` : `${Math.round(span / 3600)} h`;
}

/// "2026-11-25 09:05:30"
export function date_and_clock(time) {
  const date = new Date(1000 * time);
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())} ${clock(time)}`;
}
