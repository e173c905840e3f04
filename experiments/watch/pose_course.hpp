// SPDX-License-Identifier: Apache-2.0
// How right the pose was over a drive, counted from the scan at which the start is found: how far off and for how long,
// jumps away from a right pose, whether the covariance tells the truth, whether the map may be written meanwhile, and
// what was happening when the pose first went wrong.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/drive/mapping_drive.hpp"

namespace deltamap::experiments {

/// Why the map may not be written: "doubtful", "confirming after lost", … After scans that broke off it is
/// "confirming" alone.
[[nodiscard]] std::vector<std::string> all_whys_shut();
/// The number of a course: seconds in which that was so although the pose was right.
[[nodiscard]] std::string shut_number(const std::string& why);

/// What befell robot and world at a scan and may lead a localizer astray.
struct Befallen {
  bool change_in_view = false;
  bool person_near = false;
  bool little_in_view = false;
};

class PoseCourse {
 public:
  /// `knows_start`: the localizer was told where it begins; else the start counts as found once the pose has been
  /// tracked and right for 5 s. `robot_from_laser`: the true mount; scans may tell another.
  PoseCourse(bool knows_start, const Pose2& robot_from_laser);

  void observe(const Mapped& scan, const Befallen& befallen);

  using Numbers = std::vector<std::pair<std::string, double>>;
  /// At the end of the drive.
  [[nodiscard]] Numbers numbers() const;
  /// What was happening when the pose was first off by more than half a metre: "change, gap", for example; "start not
  /// found" where it never was, and "" where nothing went wrong.
  [[nodiscard]] std::string cause() const;

 private:
  void note_happenings(const Mapped& scan, const Befallen& befallen);
  void search(const Mapped& scan, double error_m);
  void note_error(double error_m);
  void note_laser(const Mapped& scan);
  void note_gate(const Mapped& scan, double error_m);
  [[nodiscard]] std::string happening() const;

  double now_s_ = 0.0;
  double counted_s_ = 0.0;  // since the last scan, without gaps
  bool is_after_gap_ = false;
  bool is_first_ = true;
  bool knows_start_;
  Pose2 robot_from_laser_;
  std::optional<double> near_since_s_;  // while it is searched
  std::optional<double> found_s_;
  double wrong_before_found_s_ = 0.0;

  // Since it was found.
  std::vector<double> errors_m_;
  std::vector<double> laser_errors_m_;
  double followed_s_ = 0.0;
  double off_s_ = 0.0;
  double off_for_s_ = 0.0;  // the present stretch
  double longest_off_s_ = 0.0;
  int stretches_ = 0;
  int jumps_ = 0;
  double searching_while_near_s_ = 0.0;
  double right_s_ = 0.0;
  std::map<std::string, double> shut_while_right_s_;  // by why_shut()
  std::optional<double> first_off_s_;
  std::string first_off_during_;
  struct Coverage {
    std::size_t inside = 0;
    std::size_t all = 0;
    void add(bool is_inside);
    [[nodiscard]] double share() const;
  };
  Coverage coverage_;
  Coverage coverage_after_slips_;

  // When each happened last, s.
  std::optional<double> change_s_;
  std::optional<double> slip_s_;
  std::optional<double> gap_s_;
  std::optional<double> person_s_;
  std::optional<double> empty_s_;  // little in view
  int slips_ = 0;
  int gaps_ = 0;
  double changed_view_s_ = 0.0;
  double empty_view_s_ = 0.0;

  std::size_t scans_ = 0;
  daemon::StageCpu costs_;  // of all scans
};

}  // namespace deltamap::experiments
