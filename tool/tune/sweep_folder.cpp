// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/sweep_folder.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "daemon/telemetry/version.hpp"

namespace deltamap::tool::tune {

using HeaderJson = nlohmann::ordered_json;

std::string header_of(const Drives& drives, const Variant& base) {
  HeaderJson header{{"made_by", std::string{daemon::version()} + ", commit " + std::string{daemon::commit()}}};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const DriveFiles& files = drives[i]->files();
    HeaderJson drive{{"content", drives[i]->identity()}, {"of_laser", files.way.of_laser}, {"from_s", files.from_s}};
    if (std::isfinite(files.to_s)) drive["to_s"] = files.to_s;
    drive["settings"] = HeaderJson::object();
    for (const auto& [key, value] : daemon::changed_settings(base.settings[i])) drive["settings"][key] = value;
    header["drives"][files.name] = std::move(drive);
  }
  return header.dump();
}

std::vector<MeasuredRun> kept_results(const std::vector<WantedRun>& wanted, const std::vector<Variant>& variants,
                                      Drives& drives, RunBook& book, const SweepOptions& options,
                                      const std::function<bool()>& is_interrupted) {
  try {
    return results_of(wanted, variants, drives, &book,
                      {jobs_of(options.common), false, options.budget > 0, is_interrupted});
  } catch (const std::runtime_error&) {
    if (!is_interrupted()) throw;
    const auto done = std::count_if(wanted.begin(), wanted.end(), [&](const WantedRun& one) {
      return book.run(key_of(one, variants, drives)).has_value();
    });
    throw std::runtime_error("interrupted: " + std::to_string(done) + " of " + std::to_string(wanted.size()) +
                             " runs are kept in " + options.out.string() + "; the same command goes on from there");
  }
}

}  // namespace deltamap::tool::tune
