// SPDX-License-Identifier: Apache-2.0
#include "tool/import/unpacked.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace deltamap::tool {
namespace {

constexpr std::uint64_t kMostBytes = 1'000'000'000;
constexpr std::uint64_t kMostGrowth = 20'000;  // of any of these methods; more was never so compressed

[[noreturn]] void refuse_chunk(const std::string& why) { throw std::runtime_error("a chunk " + why); }

bool is_bz2_whole(std::string_view bytes, std::string& out) {
  auto written = static_cast<unsigned>(out.size());
  // The library takes its input as it is, although it declares it writable.
  const int answer = ::BZ2_bzBuffToBuffDecompress(out.data(), &written, const_cast<char*>(bytes.data()),
                                                  static_cast<unsigned>(bytes.size()), 0, 0);
  return answer == BZ_OK && written == out.size();
}

bool is_lz4_whole(std::string_view bytes, std::string& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(::LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&::LZ4F_freeDecompressionContext)> held{context,
                                                                                    ::LZ4F_freeDecompressionContext};
  std::size_t written = 0;
  while (!bytes.empty()) {
    std::size_t taken = bytes.size();
    std::size_t room = out.size() - written;
    const std::size_t left = ::LZ4F_decompress(context, out.data() + written, &room, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0U) return false;
    written += room;
    bytes.remove_prefix(taken);
    if (left == 0) break;                       // the frame is whole
    if (taken == 0 && room == 0) return false;  // more comes out than was told
  }
  return written == out.size();
}

bool is_zstd_whole(std::string_view bytes, std::string& out) {
  const std::size_t written = ::ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  return ::ZSTD_isError(written) == 0U && written == out.size();
}

}  // namespace

std::string unpacked(std::string_view method, std::string_view bytes, std::uint64_t size) {
  if (method.empty() || method == "none") {
    if (size != bytes.size()) refuse_chunk("has another size than its head tells");
    return std::string(bytes);
  }
  if (size > kMostBytes || size > std::max<std::uint64_t>(1, bytes.size()) * kMostGrowth)
    refuse_chunk("cannot have the size that its head tells");
  std::string out(size, '\0');
  bool is_whole = false;
  if (method == "bz2") {
    is_whole = is_bz2_whole(bytes, out);
  } else if (method == "lz4") {
    is_whole = is_lz4_whole(bytes, out);
  } else if (method == "zstd") {
    is_whole = is_zstd_whole(bytes, out);
  } else {
    refuse_chunk("is compressed by \"" + std::string(method.substr(0, 20)) + "\": none, bz2, lz4 and zstd are read");
  }
  if (!is_whole) refuse_chunk("cannot be unpacked (" + std::string(method) + ")");
  return out;
}

}  // namespace deltamap::tool
