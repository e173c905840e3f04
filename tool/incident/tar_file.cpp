// SPDX-License-Identifier: Apache-2.0
#include "tool/incident/tar_file.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 512;
constexpr std::size_t kLongestName = 100;
constexpr std::uint64_t kLargest = 077777777777;  // bytes, in eleven octal digits

/// Width digits, a 0 behind them.
std::string octal(std::uint64_t number, std::size_t width) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%0*llo", static_cast<int>(width - 1),
                      static_cast<unsigned long long>(number));
  return std::string(text) + '\0';
}

std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

std::int64_t seconds_of(fs::file_time_type time) {
  const auto since_now = time - fs::file_time_type::clock::now();
  const auto then = std::chrono::system_clock::now() + since_now;
  return std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::seconds>(then.time_since_epoch()).count());
}

std::string head_of(const std::string& name, std::uint64_t size, std::int64_t time_s) {
  constexpr std::size_t kChecksumAt = 148;
  constexpr std::size_t kChecksumWidth = 8;
  std::string head = padded(name, kLongestName) + octal(0644, 8) + octal(0, 8) + octal(0, 8) + octal(size, 12) +
                     octal(static_cast<std::uint64_t>(time_s), 12) + std::string(kChecksumWidth, ' ') + '0';
  head = padded(std::move(head), 257) + std::string(
                                            "ustar\0"
                                            "00",
                                            8);
  head = padded(std::move(head), kBlock);
  const unsigned sum = std::accumulate(head.begin(), head.end(), 0u, [](unsigned sum_so_far, char c) {
    return sum_so_far + static_cast<unsigned char>(c);
  });
  return head.replace(kChecksumAt, kChecksumWidth, octal(sum, 7) + ' ');
}

}  // namespace

TarWriter::TarWriter(fs::path file) : file_{std::move(file)}, out_{file_, std::ios::binary | std::ios::trunc} {
  write("");
}

void TarWriter::write(const std::string& bytes) {
  if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw std::runtime_error(file_.string() + ": cannot be written");
}

void TarWriter::add_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.')) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  const fs::path whole = fs::absolute(folder).lexically_normal();
  const std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  for (const fs::path& file : files) add_file(name + "/" + file.filename().string(), file);
}

void TarWriter::add_file(const std::string& name, const fs::path& file) {
  const std::uint64_t size = fs::file_size(file);
  if (name.size() > kLongestName || size > kLargest)
    throw std::runtime_error(file.string() + ": its name or size does not fit a tar file");
  std::ifstream in(file, std::ios::binary);
  write(head_of(name, size, seconds_of(fs::last_write_time(file))));
  std::string piece(64 * kBlock, '\0');
  for (std::uint64_t left = size; left > 0;) {  // as much as its head says, although the daemon may write on
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size()));
    if (!in.read(piece.data(), static_cast<std::streamsize>(wanted)))
      throw std::runtime_error(file.string() + ": cannot be read");
    write(piece.substr(0, wanted));
    left -= wanted;
  }
  write(std::string((kBlock - size % kBlock) % kBlock, '\0'));
}

void TarWriter::finish() {
  write(std::string(2 * kBlock, '\0'));
  out_.close();
  if (!out_) throw std::runtime_error(file_.string() + ": cannot be written");
}

}  // namespace deltamap::tool
