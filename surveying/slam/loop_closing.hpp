// SPDX-License-Identifier: Apache-2.0
// Places that the robot has come back to: the last metres are held against submaps of older keyframes wherever the
// robot may be by what the graph knows. A loop is believed where a second one, a metre on, says the same.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

class LoopClosing {
 public:
  explicit LoopClosing(Survey& survey) : survey_{survey} {}

  /// After each new keyframe. Loops that are believed become links, and the graph is solved.
  void search_from(std::uint32_t node);
  /// A link between two drives, the first that joins the later one (link.to) to those before it.
  void join(const mapping::alignment::PoseLink& link);
  /// At the end: loops are searched for once more, keyframes of different ways that lie close by each other are
  /// matched, and links that contradict the others are taken out. False: the graph does not settle, its poses are
  /// worth nothing.
  [[nodiscard]] bool finish();

  /// Loops that were taken out again.
  [[nodiscard]] std::size_t contradicted() const { return contradicted_; }

 private:
  [[nodiscard]] std::optional<mapping::alignment::PoseLink> loop_between(std::uint32_t other, std::uint32_t node) const;
  void search(std::uint32_t node);
  void search_all(std::optional<std::uint32_t> drive);
  struct Candidate {
    std::uint32_t node = 0;
    PoseCovariance covariance;  ///< as seen from where the robot is
  };
  [[nodiscard]] std::vector<Candidate> candidates(std::uint32_t node) const;
  [[nodiscard]] bool is_way_back(std::uint32_t node, std::uint32_t other) const;
  [[nodiscard]] bool agree(const mapping::alignment::PoseLink& a, const mapping::alignment::PoseLink& b) const;
  void consider(const mapping::alignment::PoseLink& loop);
  void believe(const mapping::alignment::PoseLink& loop);
  void match_neighbours();
  bool drop_contradicted();

  Survey& survey_;
  std::vector<mapping::alignment::PoseLink> waiting_;  // for another that says the same
  std::uint32_t last_searched_ = 0;
  std::size_t unsolved_ = 0;  // links since the graph was solved
  std::size_t contradicted_ = 0;
};

}  // namespace deltamap::surveying::slam
