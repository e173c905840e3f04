// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_permission.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace deltamap::drivers::port {
namespace {

using Names = std::array<char, 4096>;

std::string name_of_group(gid_t id) {
  Names names{};
  group entry{};
  group* found = nullptr;
  (void)::getgrgid_r(id, &entry, names.data(), names.size(), &found);
  return found != nullptr ? found->gr_name : std::to_string(id);
}

std::string name_of_user(uid_t id) {
  Names names{};
  passwd entry{};
  passwd* found = nullptr;
  (void)::getpwuid_r(id, &entry, names.data(), names.size(), &found);
  return found != nullptr ? found->pw_name : std::to_string(id);
}

/// Whether this process has the rights of the group.
bool is_acting_as(gid_t id) {
  if (::getegid() == id) return true;
  std::vector<gid_t> groups(static_cast<std::size_t>(std::max(0, ::getgroups(0, nullptr))));
  const int known = ::getgroups(static_cast<int>(groups.size()), groups.data());
  groups.resize(static_cast<std::size_t>(std::max(0, known)));
  return std::find(groups.begin(), groups.end(), id) != groups.end();
}

/// Whether the group lists this user as a member; a session that began before lacks the group's rights all the same.
bool is_listed_in(gid_t id) {
  Names names{};
  group entry{};
  group* found = nullptr;
  (void)::getgrgid_r(id, &entry, names.data(), names.size(), &found);
  if (found == nullptr) return false;
  const std::string user = name_of_user(::geteuid());
  for (char** member = found->gr_mem; *member != nullptr; ++member) {
    if (user == *member) return true;
  }
  return false;
}

}  // namespace

std::string driver_of(const std::string& path) {
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0 || !S_ISCHR(device.st_mode)) return "";
  std::ifstream devices{"/proc/devices"};
  std::string driver;
  for (std::string line; std::getline(devices, line) && line != "Block devices:";) {
    std::istringstream words{line};
    unsigned number = 0;
    std::string name;
    if (words >> number >> name && number == major(device.st_rdev)) driver = name;
  }
  return driver;
}

std::string way_past_the_unit(const std::string& path) {
  const std::string driver = driver_of(path);
  return "'DeviceAllow=char-" + (driver.empty() ? "NAME" : driver) + " rw' (sudo systemctl edit deltamap)";
}

std::string why_the_unit_forbids(const std::string& path) {
  return "not by its mode, but by the unit of the service: either the driver was loaded after the start of the service "
         "(sudo systemctl restart deltamap), or the unit lacks " +
         way_past_the_unit(path);
}

std::string way_to_permission(const std::string& path) {
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0) {
    return "the folder '" + std::filesystem::path{path}.parent_path().string() + "' is closed to user '" +
           name_of_user(::geteuid()) + "'";
  }
  constexpr mode_t kGroupMay = S_IRGRP | S_IWGRP;
  constexpr mode_t kOwnerMay = S_IRUSR | S_IWUSR;
  const std::string group = name_of_group(device.st_gid);
  const std::string owner = name_of_user(device.st_uid);
  const bool is_owner = ::geteuid() == device.st_uid;
  const bool group_helps = (device.st_mode & kGroupMay) == kGroupMay && device.st_gid != 0 && !is_owner;
  if (group_helps && !is_acting_as(device.st_gid)) {
    if (is_listed_in(device.st_gid)) return "log in again: the group '" + group + "' was joined after this login";
    return "join the group '" + group + "'";
  }
  if ((device.st_mode & kOwnerMay) == kOwnerMay && !is_owner) return "only its owner '" + owner + "' may use it";
  return "its mode lets nobody but root read and write it (owner '" + owner + "', group '" + group + "')";
}

}  // namespace deltamap::drivers::port
