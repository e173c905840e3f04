// SPDX-License-Identifier: Apache-2.0
#include "core/files/foreign_file.hpp"

#include <array>

namespace deltamap {
namespace {

using namespace std::string_view_literals;

enum class What { kMap, kLog, kPicture, kPacked };

struct Kind {
  std::string_view beginning;
  What what;
  std::string_view name;
};

constexpr std::array<Kind, 21> kKinds{{
    {"2D-Map"sv, What::kMap, "a map of ARIA (Mapper3, MobileEyes)"},
    {"3D-Map"sv, What::kMap, "a map of ARIA (Mapper3, MobileEyes)"},
    {"LaserOdometryLog"sv, What::kLog, "a laser log of ARIA (.2d)"},
    {"#ROSBAG V"sv, What::kLog, "a ROS bag"},
    {"\x89MCAP0\r\n"sv, What::kLog, "a ROS 2 bag (MCAP)"},
    {"SQLite format 3\0"sv, What::kLog, "an SQLite database (a ROS 2 bag, or a map store)"},
    {"\x0A\x0D\x0D\x0A"sv, What::kLog, "a pcapng recording"},
    {"\xFF\xD8\xFF"sv, What::kPicture, "a JPEG"},
    {"GIF8"sv, What::kPicture, "a GIF"},
    {"II*\0"sv, What::kPicture, "a TIFF"},
    {"MM\0*"sv, What::kPicture, "a TIFF"},
    {"BM"sv, What::kPicture, "a BMP"},
    {"version https://git-lfs.github.com/"sv, What::kPacked,
     "a Git LFS pointer, not the file itself: `git lfs pull` brings it"},
    {"\xFD\x37zXZ\0"sv, What::kPacked, "xz-compressed; unpack it first (xz -dk)"},
    {"\x1F\x8B"sv, What::kPacked, "gzip-compressed; unpack it first (gunzip -k)"},
    {"BZh"sv, What::kPacked, "bzip2-compressed; unpack it first (bunzip2 -k)"},
    {"\x28\xB5\x2F\xFD"sv, What::kPacked, "zstd-compressed; unpack it first (unzstd -k)"},
    {"PK\x03\x04"sv, What::kPacked, "a zip archive; unpack it first (unzip)"},
    {"<!DOCTYPE html"sv, What::kPacked, "a web page, not the file itself: download the raw file"},
    {"<!doctype html"sv, What::kPacked, "a web page, not the file itself: download the raw file"},
    {"<html"sv, What::kPacked, "a web page, not the file itself: download the raw file"},
}};

bool is_netpbm_of_another_kind(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && "13467"sv.find(bytes[1]) != std::string_view::npos &&
         " \t\r\n#"sv.find(bytes[2]) != std::string_view::npos;
}

bool is_carmen_map(const std::filesystem::path& file, std::string_view head) {
  if (head.starts_with("\x1F\x8B")) return file.extension() == ".map" || file.stem().extension() == ".map";
  return head.find("CARMENMAPFILE") != std::string_view::npos;  // lines of comment come before it
}

std::string words_for(What what, std::string_view name, WantedFile wanted) {
  const std::string is = "is " + std::string(name);
  const bool wants_map = wanted == WantedFile::kMap;
  switch (what) {
    case What::kMap:
      return is + (wants_map ? "; give a map_server map (YAML and PGM)" : ", not a log");
    case What::kLog:
      return is + (wants_map ? ", no map; give a map_server map (YAML and PGM)"
                             : ", no CARMEN log: write its scans and odometry as FLASER and ODOM lines first");
    case What::kPicture:
      return is +
             (wants_map ? " picture: pictures of maps are PGM or PNG; convert it (convert IN OUT.png)" : ", not a log");
    case What::kPacked:
      break;
  }
  return is;
}

}  // namespace

std::string foreign_kind(const std::filesystem::path& file, std::string_view first_bytes, WantedFile wanted) {
  const std::string_view head = first_bytes.substr(0, kTellingBytes);
  if (is_carmen_map(file, head)) return words_for(What::kMap, "a CARMEN map", wanted);
  for (const Kind& kind : kKinds) {
    if (head.starts_with(kind.beginning)) return words_for(kind.what, kind.name, wanted);
  }
  if (is_netpbm_of_another_kind(head)) return words_for(What::kPicture, "a P" + std::string(1, head[1]), wanted);
  return "";
}

}  // namespace deltamap
