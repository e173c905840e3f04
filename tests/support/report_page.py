# SPDX-License-Identifier: Apache-2.0
"""A table as a page in the look of the experiments' reports: one file that needs nothing from elsewhere."""
import html

from project import ROOT

LOOK = ["daemon/dashboard/page/theme.css", "reports/page/report.css"]
BEHAVIOUR = "reports/page/report.js"


def cell(text, kind="td", style=""):
    return "<%s%s>%s</%s>" % (kind, ' class="%s"' % style if style else "", html.escape(str(text)), kind)


def report_page(title, lines, columns, rows):
    """`lines`: paragraphs above the table. A row's last entry is True (met) or False (missed); it stands behind the first, where a narrow screen shows it."""
    columns = [columns[0], columns[-1], *columns[1:-1]]
    style = "".join((ROOT / name).read_text() for name in LOOK)
    word = lambda row: "met" if row[-1] else "missed"
    body = "".join("<tr>%s%s%s</tr>\n" % (cell(row[0]), cell(word(row), "td", word(row)), "".join(map(cell, row[1:-1]))) for row in rows)
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
            '<meta name="color-scheme" content="light dark"><link rel="icon" href="data:,">\n<title>%s</title>\n<style>\n%s</style>\n<script>\n%s</script></head>\n'
            '<body>\n<header><h1>%s</h1><button id="theme" type="button" aria-label="Dark or light">◐</button></header>\n<main>\n%s'
            '<div class="wide" tabindex="0" role="region" aria-label="%s"><table><thead><tr>%s</tr></thead>\n<tbody>%s</tbody></table></div>\n</main></body></html>\n'
            % (html.escape(title), style, (ROOT / BEHAVIOUR).read_text(), html.escape(title),
               "".join('<p class="from">%s</p>\n' % html.escape(line) for line in lines), html.escape(title),
               "".join(cell(column, "th") for column in columns), body))
