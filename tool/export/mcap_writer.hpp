// SPDX-License-Identifier: Apache-2.0
// Writes MCAP, version 0 (https://mcap.dev/spec): messages as JSON in uncompressed chunks, with the indices that
// readers seek by. Checksums are left out, which the format allows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/time.hpp"

namespace deltamap::tool {

class McapWriter {
 public:
  using Channel = std::uint16_t;

  /// Throws std::runtime_error naming the file; so do the others.
  explicit McapWriter(std::filesystem::path file);

  /// A topic whose messages are JSON by a schema of this name; schemas of one name are one.
  [[nodiscard]] Channel add_channel(const std::string& topic, const std::string& schema_name,
                                    const std::string& json_schema);
  void write(Channel channel, Timestamp time, std::string_view json);
  /// The last chunk and the summary. To be called once, and nothing after it.
  void close();

  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  struct ChannelState {
    std::string record;  // as it stands in chunks and summary
    std::uint64_t messages = 0;
    std::uint32_t sequence = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> in_chunk;  // log time, offset
    bool is_described = false;                                      // in the file
  };
  struct Span {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool is_empty = true;
    void add(std::uint64_t time);
  };
  void put(const std::string& bytes);
  void end_chunk();
  [[nodiscard]] std::string statistics() const;

  std::filesystem::path file_;
  std::ofstream out_;
  std::uint64_t position_ = 0;
  std::map<std::string, std::pair<std::uint16_t, std::string>> schemas_;  // name → number, record
  std::vector<ChannelState> channels_;
  std::string chunk_;
  Span chunk_span_;
  Span span_;
  std::vector<std::string> chunk_indices_;
  std::uint64_t messages_ = 0;
};

}  // namespace deltamap::tool
