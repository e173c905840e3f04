// SPDX-License-Identifier: Apache-2.0
#include "core/files/picture_reader.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "core/files/foreign_file.hpp"
#include "core/files/pgm_reader.hpp"
#include "core/files/png_reader.hpp"

namespace deltamap {
namespace {

[[noreturn]] void refuse_picture(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

std::string first_bytes_of(const std::filesystem::path& file) {
  std::error_code told_below;
  if (std::filesystem::is_directory(file, told_below)) refuse_picture(file, "is a directory");
  if (std::filesystem::is_other(file, told_below))
    refuse_picture(file, "is no plain file");  // a pipe may say nothing for ever
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse_picture(file, std::generic_category().message(errno));
  std::string bytes(kTellingBytes, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

std::unique_ptr<PictureReader> open_picture(const std::filesystem::path& file) {
  const std::string bytes = first_bytes_of(file);
  if (bytes.starts_with("\x89PNG")) return open_png(file);
  if (bytes.starts_with("P5") || bytes.starts_with("P2")) return open_pgm(file);
  if (const std::string kind = foreign_kind(file, bytes, WantedFile::kMap); !kind.empty()) refuse_picture(file, kind);
  refuse_picture(file, bytes.empty() ? "byte 0: is empty" : "byte 0: neither a PGM (P5, P2) nor a PNG");
}

}  // namespace deltamap
