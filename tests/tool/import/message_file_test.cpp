// SPDX-License-Identifier: Apache-2.0
// Bags and MCAP files, whole, cut and damaged.
#include "tool/import/message_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/tool/import/message_writers.hpp"

namespace deltamap::tool {
namespace {

using Read = MessageFile (*)(std::string_view, const TakeMessage&);

std::vector<TestMessage> three_messages() {
  return {{"/a", "x/A", 1.0, "first"}, {"/b", "x/B", 2.0, std::string(500, 'b')}, {"/a", "x/A", 3.0, "third"}};
}

struct Got {
  std::vector<std::string> told;  ///< topic, type and content
  MessageFile file;
};
Got got_from(Read read, const std::string& bytes) {
  Got got;
  got.file = read(bytes, [&](const MessageView& message) {
    got.told.push_back(std::string(message.topic) + ' ' + std::string(message.type) + ' ' + std::string(message.data));
  });
  return got;
}

void expect_all_three(const Got& got) {
  EXPECT_EQ(got.told, (std::vector<std::string>{"/a x/A first", "/b x/B " + std::string(500, 'b'), "/a x/A third"}));
  EXPECT_EQ(got.file.cut, "");
  EXPECT_EQ(got.file.topics.at("/a").messages, 2u);
  EXPECT_EQ(got.file.topics.at("/b").type, "x/B");
}

TEST(MessageFile, GivesTheMessagesOfBagsHoweverTheirChunksArePacked) {
  for (const char* method : {"none", "bz2", "lz4"}) {
    SCOPED_TRACE(method);
    expect_all_three(got_from(read_bag, bag_of(three_messages(), method)));
  }
}

TEST(MessageFile, GivesTheMessagesOfMcapHoweverTheirChunksArePacked) {
  for (const char* method : {"", "lz4", "zstd"}) {
    SCOPED_TRACE(method);
    expect_all_three(got_from(read_mcap, mcap_of(three_messages(), "ros1", method)));
  }
}

TEST(MessageFile, GivesAllBeforeACutAndSaysWhereItIs) {
  const auto expect_cut = [](Read read, const std::string& whole, std::size_t from) {
    for (std::size_t size = from; size < whole.size(); ++size) {
      const Got got = got_from(read, whole.substr(0, size));
      EXPECT_LE(got.told.size(), 3u);
      const bool is_behind_a_record = got.file.cut.empty();  // a bag has no end to miss
      if (!is_behind_a_record) {
        EXPECT_TRUE(got.file.cut.starts_with("cut at byte ")) << got.file.cut;
        EXPECT_NE(got.file.cut.find(" of " + std::to_string(size)), std::string::npos) << got.file.cut;
      }
    }
  };
  expect_cut(read_bag, bag_of(three_messages(), "lz4"), 13);
  const std::string mcap = mcap_of(three_messages(), "ros1", "zstd");
  expect_cut(read_mcap, mcap.substr(0, mcap.size() - 50), 8);
  EXPECT_EQ(got_from(read_mcap, mcap.substr(0, mcap.size() - 60)).told.size(), 2u);
}

TEST(MessageFile, BearsEveryFlippedBit) {
  const std::vector<TestMessage> few{{"/a", "x/A", 1.0, "first"}, {"/a", "x/A", 3.0, "third"}};
  const auto bear = [](Read read, const std::string& whole) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (unsigned bit = 0; bit < 8; ++bit) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1u << bit));
        try {
          (void)got_from(read, bytes);
        } catch (const std::runtime_error&) {
          EXPECT_LT(at, 13u) << "of what is a bag, or MCAP, all that can be read is read";
        }
      }
    }
  };
  for (const char* method : {"none", "bz2", "lz4"}) bear(read_bag, bag_of(few, method));
  for (const char* method : {"", "lz4", "zstd"}) bear(read_mcap, mcap_of(few, "ros1", method));
}

TEST(MessageFile, RefusesWhatItIsNot) {
  const TakeMessage nobody = [](const MessageView&) {};
  EXPECT_THROW((void)read_bag("", nobody), std::runtime_error);
  EXPECT_THROW((void)read_bag("#ROSBAG V1.2\n", nobody), std::runtime_error);
  EXPECT_THROW((void)read_bag(mcap_of(three_messages(), "ros1", ""), nobody), std::runtime_error);
  EXPECT_THROW((void)read_mcap(bag_of(three_messages(), "none"), nobody), std::runtime_error);
}

TEST(MessageFile, RefusesAChunkThatWouldFillTheMemory) {
  const std::string bomb = le(std::uint64_t{0}) + le(std::uint64_t{0}) + le(std::uint64_t{1} << 40U) +
                           le(std::uint32_t{0}) + with_length("zstd") + le(std::uint64_t{4}) + "bomb";
  const Got got = got_from(read_mcap, std::string("\x89MCAP0\r\n", 8) + mcap_record(0x06, bomb));
  EXPECT_NE(got.file.cut.find("cannot have the size"), std::string::npos) << got.file.cut;
}

}  // namespace
}  // namespace deltamap::tool
