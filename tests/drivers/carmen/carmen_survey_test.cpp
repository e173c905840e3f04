// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_survey.hpp"

#include <gtest/gtest.h>

#include "drivers/carmen/carmen_words.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr std::size_t kBeams = 181;

std::string line_of(const std::vector<std::string>& ranges, std::size_t time_s) {
  std::string line = "FLASER " + std::to_string(ranges.size());
  for (const std::string& range : ranges) line += " " + range;
  return line + " 0 0 0 0 0 0 " + std::to_string(time_s) + " host 0\n";
}

/// What some logs have in place of one code: 51.05 to 51.16 m.
std::string log_with_cluster(std::size_t in_cluster) {
  std::string log;
  for (std::size_t scan = 0; scan < 10; ++scan) {
    std::vector<std::string> ranges(kBeams, "3.21");
    ranges[0] = "50.70";  // 0.35 m below the cluster
    for (std::size_t i = 0; i < in_cluster; ++i) {
      ranges[10 + i] = "51." + std::to_string(105 + (scan + i) % 12).substr(1);
    }
    log += line_of(ranges, scan);
  }
  return log;
}

/// Whether each value of the first scan is a range.
std::vector<bool> ranges_in(const std::filesystem::path& file, const CarmenSurvey& survey) {
  CarmenLog log{file};
  const auto scan = std::get<CarmenScan>(log.next().value());
  const CarmenWords words{scan, survey};
  std::vector<bool> are_ranges;
  for (const double range_m : scan.ranges_m) are_ranges.push_back(words.is_range(range_m));
  return are_ranges;
}

TEST(CarmenSurvey, TakesAClusterOfLargestValuesForNoReturn) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.log", log_with_cluster(10));  // no single value has 0.5 % of the beams
  const CarmenSurvey survey = survey_of(file, std::nullopt);
  EXPECT_EQ(survey.no_return_m, 51.05);
  EXPECT_EQ(survey.no_return_up_to_m, 51.16);
  EXPECT_NEAR(survey.no_return_share, 10.0 / kBeams, 1e-9);
  EXPECT_EQ(no_return_line(survey).find("no return: the log's largest values 51.05 to 51.16 m, 5.52"), 0u)
      << no_return_line(survey);
  std::vector<bool> expected(kBeams, true);
  for (std::size_t i = 10; i < 20; ++i) expected[i] = false;
  EXPECT_EQ(ranges_in(file, survey), expected);

  const CarmenSurvey given = survey_of(file, 60.0);
  EXPECT_EQ(ranges_in(file, given), std::vector<bool>(kBeams, true));
  EXPECT_EQ(no_return_line(given), "no return: 60 m and more, as given");
}

TEST(CarmenSurvey, FewLargestValuesAreRanges) {
  const test::TemporaryFolder folder;
  std::string log = log_with_cluster(0);
  log.replace(log.find("3.21"), 4, "51.16");  // 1 of 1810 beams
  const auto file = folder.write("a.log", log);
  const CarmenSurvey survey = survey_of(file, std::nullopt);
  EXPECT_FALSE(survey.no_return_m);
  EXPECT_EQ(ranges_in(file, survey), std::vector<bool>(kBeams, true));
}

TEST(CarmenSurvey, KeepsRangesJustBelowTheScannersCodes) {
  const test::TemporaryFolder folder;
  std::vector<std::string> ranges(kBeams, "8.100");  // mm, 8 m mode: a wall there is as good as any
  std::vector<bool> expected(kBeams, true);
  for (std::size_t i = 0; i < 20; ++i) {
    ranges[i] = i % 2 == 0 ? "8.183" : "8.191";
    expected[i] = false;
  }
  const auto file = folder.write("a.log", line_of(ranges, 1));
  const CarmenSurvey survey = survey_of(file, std::nullopt);
  EXPECT_EQ(survey.no_return_m, 8.183);
  EXPECT_EQ(ranges_in(file, survey), expected);
}

}  // namespace
}  // namespace deltamap::drivers::carmen
