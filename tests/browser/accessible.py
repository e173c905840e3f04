# SPDX-License-Identifier: Apache-2.0
"""What WCAG 2.2 (A, AA) asks of a page that a program can tell: names and roles as a screen reader hears them, contrast, ids, order, size of
what is touched. Debian has no axe; these are its serious rules that concern pages without foreign content. Who has axe-core names its axe.min.js in
$DELTAMAP_AXE: then it judges as well, and nothing that it calls serious or critical may be found."""
import os
import pathlib

from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

INTERACTIVE = {"button", "link", "checkbox", "slider", "combobox", "textbox", "radio", "switch", "tab", "menuitem", "spinbutton", "DisclosureTriangle"}
NAMED = INTERACTIVE | {"image", "img", "region", "group", "toolbar", "dialog", "navigation"}

# Text that can be seen, with its colour, what lies behind it, and its size.
CONTRASTS = """
const parse = (text) => { const n = text.match(/[\\d.]+/g).map(Number); return { rgb: n.slice(0, 3), alpha: n[3] ?? 1 }; };
const over = (top, below) => top.rgb.map((c, i) => top.alpha * c + (1 - top.alpha) * below[i]);
function behind(element) {
  const layers = [];
  for (let one = element; one; one = one.parentElement) layers.unshift(parse(getComputedStyle(one).backgroundColor));
  return layers.reduce((below, layer) => over(layer, below), [255, 255, 255]);
}
const luminance = (rgb) => rgb.map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
  .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
const poor = [];
let seen = 0;
while (walker.nextNode()) {
  const element = walker.currentNode.parentElement;
  if (!walker.currentNode.textContent.trim() || !element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
  if (["SCRIPT", "STYLE"].includes(element.tagName) || element.closest(":disabled")) continue;
  const style = getComputedStyle(element), is_svg = element instanceof SVGElement;
  const below = behind(is_svg ? element.ownerSVGElement : element);
  const ink = over(parse(is_svg ? style.fill : style.color), below);
  const [high, low] = [luminance(ink), luminance(below)].sort((a, b) => b - a);
  const ratio = (high + 0.05) / (low + 0.05), px = parseFloat(style.fontSize);
  const is_large = px >= 24 || (px >= 18.66 && Number(style.fontWeight) >= 700);
  ++seen;
  if (ratio < (is_large ? 3 : 4.5)) poor.push(`${ratio.toFixed(2)}: ${walker.currentNode.textContent.trim().slice(0, 40)}`);
}
return { poor, seen };"""

STRUCTURE = """
const wrong = [], all = [...document.querySelectorAll("*")];
const ids = all.map((one) => one.id).filter(Boolean);
for (const id of new Set(ids)) if (ids.filter((one) => one === id).length > 1) wrong.push(`id twice: ${id}`);
for (const one of all) {
  for (const name of ["aria-labelledby", "aria-describedby", "aria-controls", "for"]) {
    for (const id of (one.getAttribute(name) ?? "").split(" ").filter(Boolean)) if (!document.getElementById(id)) wrong.push(`${name} leads nowhere: ${id}`);
  }
  if (one.tabIndex > 0) wrong.push(`an order of its own: ${one.outerHTML.slice(0, 60)}`);
  if (one.closest("[aria-hidden=true]") && one.tabIndex >= 0 && one.matches("button, input, a, [tabindex]")) wrong.push(`focus on what is hidden: ${one.id}`);
}
const OPERABLE = "button:not(:disabled), input:not(:disabled), select, summary, a[href], [tabindex='0']";
for (const one of document.body.querySelectorAll("*")) {
  const { overflowX, overflowY } = getComputedStyle(one), scrolls = (overflow, size, room) => ["auto", "scroll"].includes(overflow) && size > room + 1;
  const does = scrolls(overflowY, one.scrollHeight, one.clientHeight) || scrolls(overflowX, one.scrollWidth, one.clientWidth);
  const has_focusable = one.tabIndex >= 0 || [...one.querySelectorAll(OPERABLE)].some((inner) => inner.checkVisibility());
  if (does && one.checkVisibility() && !has_focusable) wrong.push(`scrollable-region-focusable: ${one.id || one.outerHTML.slice(0, 60)}`);
}
if (!document.documentElement.lang) wrong.push("no language");
if (!document.title) wrong.push("no title");
if (document.querySelectorAll("h1").length !== 1) wrong.push("not one h1");
if (document.querySelectorAll("main").length !== 1) wrong.push("not one main");
const levels = [...document.querySelectorAll("h1, h2, h3, h4")].map((one) => Number(one.tagName[1]));
levels.forEach((level, i) => { if (i && level > levels[i - 1] + 1) wrong.push(`h${level} after h${levels[i - 1]}`); });
const LEAST_PX = 24;
for (const one of document.querySelectorAll("button, input, select, summary, a")) {
  const box = (one.labels?.[0] ?? one).getBoundingClientRect();
  if (one.checkVisibility() && box.width && (box.width < LEAST_PX || box.height < LEAST_PX)) wrong.push(`small to touch, ${box.width.toFixed(0)} × ${box.height.toFixed(0)}: ${one.id || one.textContent}`);
}
return wrong;"""

# Elements that stick out of the window, but for what scrolls by itself.
STICKS_OUT = """
return [...document.querySelectorAll("body *")].filter((one) => !one.parentElement.closest(".wide"))
  .filter((one) => one.getBoundingClientRect().right > innerWidth + 0.5 || one.getBoundingClientRect().left < -0.5)
  .map((one) => one.tagName + "#" + one.id);"""


AXE = """
return axe.run(document, { resultTypes: ["violations"] }).then(({ violations, passes }) => ({
  passed: passes.length,
  serious: violations.filter(({ impact }) => ["serious", "critical"].includes(impact)).map(({ id, nodes }) => `axe: ${id}: ${nodes[0].html.slice(0, 80)}`),
}));"""


def found_by_axe(browser):
    if not (file := os.environ.get("DELTAMAP_AXE")):
        return []
    told = browser.execute_script(pathlib.Path(file).read_text() + AXE)
    return told["serious"] + ([] if told["passed"] else ["axe passed nothing: it sees nothing"])


def findings(browser):
    """What is wrong, as lines; empty where nothing is."""
    found = []
    nodes = browser.accessibility_tree()
    for node in nodes:
        if node["role"] in NAMED and not node["name"]:
            found.append(f"no name: {node['role']}")
        if node["properties"].get("focusable") and node["role"] in ("generic", "none", ""):
            found.append(f"takes the focus without a role: {node['name']}")
    if not any(node["role"] in INTERACTIVE for node in nodes):
        found.append("the tree holds nothing that can be used: the check sees nothing")
    contrast = browser.execute_script(CONTRASTS)
    if contrast["seen"] < 5:
        found.append("no text was seen: the check sees nothing")
    return found + [f"contrast {line}" for line in contrast["poor"]] + browser.execute_script(STRUCTURE) + found_by_axe(browser)


# Where the focus is, and whether one sees it.
FOCUS = """
const one = document.activeElement, style = getComputedStyle(one);
return { what: one.id || one.ariaLabel || one.textContent.trim().slice(0, 30) || one.tagName, tag: one.tagName,
         is_seen: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1 };"""
CAN_TAKE_FOCUS = """
return [...document.querySelectorAll("button, input, select, summary, a[href], [tabindex='0']")]
  .filter((one) => !one.disabled && one.checkVisibility({ visibilityProperty: true }) && !(one.closest("details:not([open])") && one.tagName !== "SUMMARY")).length;"""


def walk(browser, most=200):
    """Tab by tab through the page: the stops, until the focus leaves or comes round."""
    browser.execute_script("document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex'); window.scrollTo(0, 0)")  # from the top
    stops = []
    for _ in range(most):
        ActionChains(browser).key_down(Keys.TAB).key_up(Keys.TAB).perform()
        stop = browser.execute_script(FOCUS)
        if stop["tag"] == "BODY" or (stops and stop == stops[0]):
            break
        stops.append(stop)
    return stops
