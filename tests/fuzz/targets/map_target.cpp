// SPDX-License-Identifier: Apache-2.0
// Maps: the input is a description, a line "---", and its picture.
#include "core/files/grid_file.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  const std::string_view text = fuzz::text_of({data, size});
  const std::size_t rule = text.find("---\n");
  if (rule == std::string_view::npos) return 0;
  const fuzz::MemoryFile picture{std::span{data, size}.subspan(rule + 4)};
  const std::string described = "image: " + picture.path().string() + "\n" + std::string(text.substr(0, rule));
  const fuzz::MemoryFile file{{reinterpret_cast<const std::uint8_t*>(described.data()), described.size()}};
  try {
    (void)read_grid(file.path());
  } catch (const std::runtime_error&) {
  }
  return 0;
}
