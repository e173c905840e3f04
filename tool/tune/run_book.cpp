// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/run_book.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "core/files/text_of_file.hpp"

namespace deltamap::tool::tune {
namespace {

namespace fs = std::filesystem;
using BookJson = nlohmann::ordered_json;

std::string line_of(const std::string& key, const MeasuredRun& run) {
  BookJson line{{"run", key}, {"trajectory", run.trajectory}, {"map", run.map}, {"numbers", BookJson::object()}};
  for (const auto& [name, value] : run.numbers) {
    line["numbers"][name] = std::isfinite(value) ? BookJson(value) : BookJson(nullptr);
  }
  return line.dump() + "\n";
}

MeasuredRun run_of(const BookJson& line) {
  MeasuredRun run{{}, line.at("trajectory"), line.at("map")};
  for (const auto& [name, value] : line.at("numbers").items()) {
    run.numbers.emplace_back(name, value.is_null() ? std::nan("") : value.get<double>());
  }
  return run;
}

/// "drives/intel/settings/localization.beams: 60, now 90", for the first thing that differs.
std::string first_difference(const BookJson& then, const BookJson& now, const std::string& path = "") {
  if (then.is_object() && now.is_object()) {
    BookJson both = then;
    both.update(now);
    for (const auto& [name, ignored] : both.items()) {
      const BookJson a = then.value(name, BookJson(nullptr));
      const BookJson b = now.value(name, BookJson(nullptr));
      if (a != b) return first_difference(a, b, path + (path.empty() ? "" : "/") + name);
    }
  }
  const auto text = [](const BookJson& value) { return value.is_null() ? std::string{"not given"} : value.dump(); };
  return path + ": " + text(then) + ", now " + text(now);
}

}  // namespace

RunBook::RunBook(const fs::path& folder, const std::string& header, bool anew) : file_{folder / "runs.jsonl"} {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
  lock_ = lock_of_file(file_);
  const bool goes_on = !anew && fs::exists(file_);
  if (goes_on) read(text_of_file(file_), header);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (anew ? O_TRUNC : 0), 0644);
  if (descriptor_ < 0) throw std::runtime_error(file_.string() + ": " + std::generic_category().message(errno));
  if (fs::file_size(file_) == 0) append(header + "\n");
}

RunBook::~RunBook() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RunBook::read(const std::string& content, const std::string& header) {
  const std::size_t whole = content.rfind('\n') + 1;  // 0: no line is whole
  std::size_t number = 0;
  for (std::size_t at = 0; at < whole;) {
    const std::size_t end = content.find('\n', at);
    const BookJson line = BookJson::parse(content.substr(at, end - at), nullptr, false);
    at = end + 1;
    ++number;
    if (number == 1 && line.is_object() && line.contains("drives")) {
      const BookJson now = BookJson::parse(header);
      if (line == now) continue;
      throw std::runtime_error(file_.string() + ": was begun with something else (" + first_difference(line, now) +
                               "): give another --out, or --anew to leave its runs");
    }
    if (number == 1 || !line.is_object() || !line.contains("run")) {
      throw std::runtime_error(file_.string() + ": line " + std::to_string(number) +
                               ": is none of a sweep; give another --out");
    }
    runs_.insert_or_assign(line["run"].get<std::string>(), run_of(line));
  }
  std::error_code error;
  if (whole < content.size()) fs::resize_file(file_, whole, error);
  if (error) throw std::runtime_error(file_.string() + ": cannot be written: " + error.message());
}

std::optional<MeasuredRun> RunBook::run(const std::string& key) const {
  const auto found = runs_.find(key);
  return found == runs_.end() ? std::nullopt : std::optional{found->second};
}

void RunBook::add(const std::string& key, const MeasuredRun& run) {
  append(line_of(key, run));
  MeasuredRun kept = run;
  kept.poses.clear();
  runs_.insert_or_assign(key, std::move(kept));
}

void RunBook::append(const std::string& line) {
  const auto before = static_cast<off_t>(fs::file_size(file_));
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size())) return;
  const int reason = written < 0 ? errno : ENOSPC;
  (void)!::ftruncate(descriptor_, before);
  throw std::runtime_error(file_.string() + ": cannot be written: " + std::generic_category().message(reason));
}

}  // namespace deltamap::tool::tune
