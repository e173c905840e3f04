// SPDX-License-Identifier: Apache-2.0
#include "daemon/site_drawing.hpp"

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "core/counted.hpp"
#include "core/files/file_lock.hpp"
#include "core/files/keep_earlier.hpp"
#include "core/files/replace_file.hpp"
#include "core/files/text_of_file.hpp"
#include "daemon/site/bays_file.hpp"
#include "daemon/site/zones_file.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

std::string list_of(PlaceKind kind) { return kind == PlaceKind::kBay ? "bays" : "zones"; }

const std::string& file_of(const Settings& settings, PlaceKind kind) {
  return kind == PlaceKind::kBay ? settings.bays.file : settings.zones.file;
}

/// Whether the file's text says what is in force; throws std::runtime_error where it says nothing.
bool holds(const std::string& text, const Site& site, PlaceKind kind, const std::string& file) {
  return kind == PlaceKind::kBay ? bays_of_text(text, file) == site.bays : zones_of_text(text, file) == site.zones;
}

/// The text that stands there. Throws std::runtime_error where it is not what is in force: a person has written it, and
/// it must not be lost.
std::string text_in_force(const std::string& file, const Site& site, PlaceKind kind) {
  const std::string reload = ": say `deltamap ctl reload`, look at it, and draw again";
  std::string text;
  try {
    text = text_of_file(file);
  } catch (const std::exception& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
  bool is_in_force = false;
  try {
    is_in_force = holds(text, site, kind, file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(error.what() + std::string("; somebody has written so since the last reload: mend it"));
  }
  if (!is_in_force) throw std::runtime_error(file + " has been written by somebody since the last reload" + reload);
  return text;
}

/// What a person can do where a file cannot be written.
std::string way_out(const std::error_code& why, PlaceKind kind) {
  const bool is_full =
      why == std::errc::no_space_on_device || why == std::errc::file_too_large || why.value() == EDQUOT;
  if (is_full) return "make room on that disk, and draw again: all is as it was";
  if (why == std::errc::io_error) return "look at that disk (`dmesg`): all is as it was";
  return "name a place for '" + list_of(kind) + ".file' where the daemon may write, as its folder of state";
}

/// Where the earlier text is kept; empty: a rewrite loses nothing. Throws std::runtime_error.
std::string replaced(const std::string& file, const std::string& before, const Site& site, const Site& wanted,
                     PlaceKind kind) {
  const std::string text = file_text(wanted, kind);
  try {
    if (before != file_text(site, kind))
      return replace_and_keep(file, before, text, drivers::port::port_clock_now()).string();
    replace_file(file_behind(file), text);
  } catch (const std::system_error& why) {
    throw std::runtime_error(std::string(why.what()) + ": " + way_out(why.code(), kind));
  }
  return "";
}

std::string words_of_drawn(const Site& wanted, PlaceKind kind, const std::string& file, const std::string& kept) {
  const std::size_t count = kind == PlaceKind::kBay ? wanted.bays.size() : wanted.zones.size();
  const std::string words = "in force, and written: " + counted(count, std::string(name_of(kind))) + " in " + file;
  return kept.empty() ? words : words + "; what that loses (comments, layout) is kept in " + kept;
}

}  // namespace

control::CommandOutcome draw_on_site(const Settings& settings, const GridGeometry& map, const SiteEditOrder& order,
                                     const SiteInForce& in_force) {
  const SiteEdit& edit = order.edit;
  const std::string& file = file_of(settings, edit.kind);
  const auto refused = [&](std::string why) { return control::CommandOutcome{order.ticket, false, std::move(why)}; };
  if (file.empty()) {
    const std::string list = list_of(edit.kind);
    return refused("'" + list + ".file' names no file: set it to one that holds '" + list + ":', and restart");
  }
  const SharedSite site = in_force.newest.newest();
  if (edit.version != version_of(*site, edit.kind)) {
    return refused("the " + list_of(edit.kind) +
                   " are others by now, somebody has drawn or reloaded: look at them again, then draw");
  }
  control::CommandOutcome outcome{.ticket = order.ticket, .message = {}};
  SharedSite wanted;
  try {
    const std::string before = text_in_force(file, *site, edit.kind);
    wanted = std::make_shared<const Site>(edited(*site, edit, map, fs::path(file).filename().string()));
    if (*wanted == *site) return {.ticket = order.ticket, .message = "nothing was another way: it stays as it is"};
    const std::string kept = replaced(file, before, *site, *wanted, edit.kind);
    outcome.message = words_of_drawn(*wanted, edit.kind, file, kept);
  } catch (const std::runtime_error& error) {
    return refused(error.what());
  }
  if (!in_force.sites.try_send(SharedSite{wanted}))
    return refused(file + " is written, and not in force: the daemon is busy, say `deltamap ctl reload`");
  in_force.newest.set(wanted);
  for (const std::string& line : warnings_of(*wanted, settings, in_force.telemetry)) {
    outcome.message += "; " + line;
    outcome.doubt = true;
  }
  return outcome;
}

}  // namespace deltamap::daemon
