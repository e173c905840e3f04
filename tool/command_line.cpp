// SPDX-License-Identifier: Apache-2.0
#include "tool/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/control/request.hpp"
#include "daemon/settings/reader/nearest_key.hpp"
#include "daemon/settings/settings_error.hpp"

namespace deltamap::tool {
namespace {

/// Whoever reads the replies of the daemon as JSON reads what has kept them away the same way.
void tell_in_json(int argc, const char* const* argv, const std::string& error) {
  const auto is = [&](int at, std::string_view word) { return argv[at] == word; };
  bool is_asked = false;
  for (int at = 2; at < argc && is(1, "ctl"); ++at) is_asked = is_asked || is(at, "--json");
  if (is_asked) std::cout << daemon::control::error_line(error) << std::endl;
}

std::vector<const CLI::App*> commands_of(const CLI::App& parent) {
  return parent.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* one : commands) names.push_back(one->get_name());
  return names;
}

/// Of the commands here, else of those one level below: "ctl status" for "stauts".
std::optional<std::string> nearest_command(const CLI::App& parent, const std::string& word) {
  const std::vector<const CLI::App*> here = commands_of(parent);
  if (const auto nearest = daemon::nearest_of(names_of(here), word)) return nearest;
  for (const CLI::App* one : here) {
    const auto nearest = daemon::nearest_of(names_of(commands_of(*one)), word);
    if (nearest) return one->get_name() + " " + *nearest;
  }
  return std::nullopt;
}

/// "ctl: unknown command 'stauts' (nearest command status)", or "ctl: which command? status, pause, …". Nothing where
/// it is no command that is missing.
std::optional<std::string> wrong_command(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_name() != "RequiredError") return std::nullopt;
  const CLI::App* parent = &app;
  std::string path;
  while (!parent->get_subcommands().empty()) {
    parent = parent->get_subcommands().front();
    path += parent->get_name() + " ";
  }
  if (commands_of(*parent).empty()) return std::nullopt;
  if (!path.empty()) path.back() = ':';
  if (!path.empty()) path += ' ';
  const std::vector<std::string> words = app.remaining(true);
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const auto word = std::find_if_not(words.begin(), words.end(), is_option);
  if (word != words.end()) {
    const auto nearest = nearest_command(*parent, *word);
    return path + "unknown command '" + *word + "'" + (nearest ? " (nearest command " + *nearest + ")" : "");
  }
  if (std::string_view(error.what()) != CLI::RequiredError::Subcommand(1).what()) return std::nullopt;
  std::string known;
  for (const std::string& name : names_of(commands_of(*parent))) known += (known.empty() ? "" : ", ") + name;
  return path + "which command? " + known;
}

/// Prints it, and returns the exit code.
int refuse(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  const auto wrong = wrong_command(app, error);
  const CLI::ParseError told = wrong ? CLI::ParseError{*wrong, CLI::ExitCodes::RequiredError} : error;
  if (app.exit(told) == 0) return 0;
  tell_in_json(argc, argv, told.what());
  return 2;
}

}  // namespace

int answer_of(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
    if (!std::cout.flush()) throw std::runtime_error("standard output: cannot be written");
  } catch (const CLI::ParseError& error) {
    return refuse(app, error, argc, argv);
  } catch (const daemon::SettingsError& error) {
    for (const std::string& problem : error.lines()) std::cerr << app.get_name() << ": " << problem << '\n';
    return 2;
  } catch (const std::exception& error) {
    tell_in_json(argc, argv, error.what());
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace deltamap::tool
