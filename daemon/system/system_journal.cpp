// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/system_journal.hpp"

#include <sys/stat.h>
#include <sys/uio.h>
#include <syslog.h>
#define SD_JOURNAL_SUPPRESS_LOCATION  // the journal would name this source file for every line
#include <systemd/sd-journal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string_view>

namespace deltamap::daemon::system_journal {
namespace {

int priority_of(LogLevel level) {
  switch (level) {
    case LogLevel::kError:
      return LOG_ERR;
    case LogLevel::kWarn:
      return LOG_WARNING;
    case LogLevel::kInfo:
      return LOG_INFO;
    case LogLevel::kDebug:
    case LogLevel::kTrace:
      break;
  }
  return LOG_DEBUG;
}

bool is_in_key(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '_';
}

/// The journal's field for a key: "DELTAMAP_REVISION" for "revision"; empty where the word is no key.
std::string field_name(std::string_view key) {
  const bool is_key =
      !key.empty() && key.size() <= 32 && key.front() >= 'a' && std::all_of(key.begin(), key.end(), is_in_key);
  if (!is_key) return "";
  std::string name = "DELTAMAP_";
  for (const char letter : key) name += static_cast<char>(letter >= 'a' ? letter - 'a' + 'A' : letter);
  return name;
}

/// The word in front of the '=' at `equals`.
std::string_view key_before(std::string_view line, std::size_t equals) {
  const std::size_t blank = line.rfind(' ', equals);
  const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
  return line.substr(begin, equals - begin);
}

/// Where the next "key=" begins, with the blank before it.
std::size_t next_key(std::string_view line, std::size_t from) {
  for (std::size_t at = line.find('=', from); at != std::string_view::npos; at = line.find('=', at + 1)) {
    const std::string_view key = key_before(line, at);
    if (at - key.size() > from && !field_name(key).empty()) return at - key.size() - 1;
  }
  return line.size();
}

/// The value that begins at `begin`: one word, or several for the keys whose values hold blanks.
std::string_view value_at(std::string_view line, std::size_t begin, std::string_view key) {
  if (key == "reason") return line.substr(begin);
  if (key == "file" || key == "size") return line.substr(begin, next_key(line, begin) - begin);
  std::string_view value = line.substr(begin, line.find(' ', begin) - begin);
  while (!value.empty() && (value.back() == ',' || value.back() == ';' || value.back() == ':')) value.remove_suffix(1);
  return value;
}

}  // namespace

bool is_behind_stderr() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat state {};
  unsigned long long device = 0;
  unsigned long long inode = 0;
  if (stream == nullptr || std::sscanf(stream, "%llu:%llu", &device, &inode) != 2) return false;
  return ::fstat(STDERR_FILENO, &state) == 0 && state.st_dev == device && state.st_ino == inode;
}

std::vector<std::string> fields_of(LogLevel level, const std::string& line) {
  std::vector<std::string> fields{"MESSAGE=" + line, "PRIORITY=" + std::to_string(priority_of(level)),
                                  "SYSLOG_IDENTIFIER=deltamapd"};
  const std::string_view text = line;
  std::set<std::string> told;
  for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
    const std::string_view key = key_before(text, at);
    const std::string name = field_name(key);
    const std::string_view value = value_at(text, at + 1, key);
    if (name.empty() || value.empty() || !told.insert(name).second) continue;
    fields.push_back(name + "=" + std::string(value));
  }
  return fields;
}

bool write(LogLevel level, const std::string& line) {
  std::vector<std::string> fields = fields_of(level, line);
  std::vector<iovec> parts;
  for (std::string& field : fields) parts.push_back({field.data(), field.size()});
  return sd_journal_sendv(parts.data(), static_cast<int>(parts.size())) >= 0;
}

}  // namespace deltamap::daemon::system_journal
