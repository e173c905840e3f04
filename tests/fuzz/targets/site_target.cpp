// SPDX-License-Identifier: Apache-2.0
// Bays and zones of a site. The first byte chooses: '0' bays.yaml, '1' zones.yaml, '2' stations of LIF, '3' a table,
// '4' a recording's own. What is read is written and read again, and must be the same.
#include "daemon/site/bays_file.hpp"
#include "daemon/site/site.hpp"
#include "daemon/site/zones_file.hpp"
#include "tests/fuzz/input.hpp"
#include "tool/bays/bay_import.hpp"

namespace {

using namespace deltamap;

void require_kept(const std::vector<mapping::bays::Bay>& bays) {
  if (daemon::bays_of_text(daemon::bays_as_yaml(bays), "again") != bays) __builtin_trap();
}

/// A station is a point and its sides may end between two millimetres: kept is what the file has of it.
void require_written_as_one_reads(const std::vector<mapping::bays::Bay>& bays) {
  daemon::require_sound_bays(bays, "import");
  const std::string written = daemon::bays_as_yaml(bays);
  if (daemon::bays_as_yaml(daemon::bays_of_text(written, "again")) != written) __builtin_trap();
}

void read(std::uint8_t kind, const std::string& text) {
  constexpr tool::BaySize kSize{2.4, 1.2};
  switch (kind % 5) {
    case 0:
      return require_kept(daemon::bays_of_text(text, "bays"));
    case 1: {
      const Zones zones = daemon::zones_of_text(text, "zones");
      if (daemon::zones_of_text(daemon::zones_as_yaml(zones), "again") != zones) __builtin_trap();
      return;
    }
    case 2:
      return require_written_as_one_reads(tool::bays_of_lif(text, "lif", kSize).bays);
    case 3:
      return require_written_as_one_reads(tool::bays_of_csv(text, "csv", kSize).bays);
    default:
      (void)daemon::site_of_text(text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read(static_cast<std::uint8_t>(data[0] - '0'), std::string(fuzz::text_of({data + 1, size - 1})));
  } catch (const std::runtime_error&) {
  }
  return 0;
}
