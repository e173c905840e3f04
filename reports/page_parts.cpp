// SPDX-License-Identifier: Apache-2.0
#include "reports/page_parts.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include "daemon/dashboard/page_files.hpp"
#include "daemon/telemetry/version.hpp"
#include "reports/report_files.hpp"
#include "reports/svg_chart.hpp"

namespace deltamap::reports {
namespace {

std::string file_of(std::span<const daemon::dashboard::PageFile> files, std::string_view name) {
  const auto file = std::find_if(files.begin(), files.end(), [&](const auto& one) { return one.name == name; });
  return std::string{file == files.end() ? std::string_view{} : file->content};
}

std::string head_html(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<meta name=\"color-scheme\" content=\"light dark\"><link rel=\"icon\" href=\"data:,\">\n<title>" +
         escaped(title) + "</title>\n<style>\n" + file_of(daemon::dashboard::page_files(), "theme.css") +
         file_of(page_files(), "report.css") + "</style>\n<script>\n" + file_of(page_files(), "report.js") +
         "</script></head>\n";
}

}  // namespace

std::string cell(const std::string& text, const char* kind, const char* style) {
  const std::string open = style == nullptr ? std::string{kind} : std::string{kind} + " class=\"" + style + "\"";
  return "<" + open + ">" + escaped(text) + "</" + kind + ">";
}

std::string table_of(const std::string& name, const std::vector<std::string>& columns, const std::string& rows) {
  std::string html =
      "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped(name) + "\"><table><thead><tr>";
  for (const std::string& column : columns) html += cell(column, "th");
  return html + "</tr></thead>\n<tbody>" + rows + "</tbody></table></div>\n";
}

std::string page_begin(const std::string& title) {
  return head_html(title) + "<body>\n<header><h1>" + escaped(title) +
         "</h1><button id=\"theme\" type=\"button\" aria-label=\"Dark or light\">◐</button></header>\n<main>\n";
}

std::string page_end() { return "</main></body></html>\n"; }

std::string provenance_text(const daemon::Settings& settings) {
  std::string text = "deltamap " + std::string(daemon::version()) + ", commit " + std::string(daemon::commit()) +
                     "; settings as delivered";
  const char* before = ", but ";
  for (const auto& [key, value] : daemon::changed_settings(settings)) {
    text += before + key + ": " + value;
    before = ", ";
  }
  return text + ".";
}

}  // namespace deltamap::reports
