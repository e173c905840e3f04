// SPDX-License-Identifier: Apache-2.0
// What a recording holds, as people and programs read it.
#pragma once

#include <string>

#include "tool/info/recording_survey.hpp"

namespace deltamap::tool {

/// Whether a replay repeats the recorded run bit for bit.
struct RepeatAnswer {
  bool can = false;  ///< with the settings and the map of the run
  std::string why;   ///< a line: why not, or with what
};

/// By the recording alone.
[[nodiscard]] RepeatAnswer repeat_answer(const RecordingSurvey& survey);

[[nodiscard]] std::string info_text(const RecordingSurvey& survey, const RepeatAnswer& repeat);
/// A JSON object.
[[nodiscard]] std::string info_json(const RecordingSurvey& survey, const RepeatAnswer& repeat);

/// Of the operator, in order: "mapping paused", "relocalized to 1.000, 2.000, 90.0", "undo of 7 by an operator",
/// "bays: 64, zones: 4".
[[nodiscard]] std::string words_of_command(const daemon::Decision& command);
/// Bays and zones that the run began with: no order of an operator.
[[nodiscard]] bool is_of_begin(const daemon::Decision& command);
/// Theirs; empty where it began with none.
[[nodiscard]] std::string words_of_begin(const RecordingSurvey& survey);

}  // namespace deltamap::tool
