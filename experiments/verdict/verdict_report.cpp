// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/verdict_report.hpp"

#include <cmath>
#include <string>

#include "experiments/verdict/verdict_part.hpp"
#include "experiments/verdict/verdict_run.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRecovery_s = 30.0;

double share_of(double part, double whole) { return whole > 0.0 ? part / whole : std::nan(""); }

std::string of(double part, double whole) { return text_of(part) + " of " + text_of(whole); }

/// Over all runs of a part: the tiles that its robots had learned before. NaN where there are none.
double mean_tiles(const std::vector<Outcome>& outcomes, const std::string& place, double range_m) {
  std::vector<double> tiles;
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("place") == place && outcome.label("range_m") == text_of(range_m)) {
      tiles.push_back(outcome.number("proven_tiles"));
    }
  }
  return mean_of(tiles);
}

TextTable table_of(const std::vector<Outcome>& outcomes, const std::string& place) {
  TextTable table{
      place,
      {"event", "changed", "range, m", "runs", "ambiguous runs", "runs once wrong", "wrong called right > 5 s",
       "right called lost", "recovered in 30 s, unambiguous", "recovered in 30 s, ambiguous", "recovered at all",
       "called right again", "noticed after, mean s", "Brier score of P(pose right)", "Brier score of P(map wrong)"},
      {}};
  for (const PoseEvent event : kPoseEvents) {
    for (const double changed : kVerdictChangedShares) {
      for (const double range_m : kVerdictRanges_m) {
        const auto here = [&](const Outcome& o) {
          return o.label("place") == place && o.label("event") == name_of(event) &&
                 o.label("changed") == text_of(changed) && o.label("range_m") == text_of(range_m);
        };
        const VerdictPart part{outcomes, here};
        const VerdictPart clear{outcomes, [&](const Outcome& o) { return here(o) && !is_ambiguous(o); }};
        const VerdictPart ambiguous{outcomes, [&](const Outcome& o) { return here(o) && is_ambiguous(o); }};
        if (part.runs() == 0.0) continue;
        const double wrong = part.once_wrong();
        table.rows.push_back(
            {std::string{name_of(event)}, text_of(100.0 * changed) + " %", text_of(range_m), text_of(part.runs()),
             text_of(part.ambiguous()), text_of(wrong), text_of(part.wrong_called_right()),
             of(part.right_called_lost(), part.runs() - wrong), of(clear.recovered_in(kRecovery_s), clear.once_wrong()),
             of(ambiguous.recovered_in(kRecovery_s), ambiguous.once_wrong()), of(part.recovered_in(HUGE_VAL), wrong),
             of(part.called_right_again_in(HUGE_VAL), wrong), text_of(part.mean_noticed_s()),
             text_of(part.pose().brier()), text_of(part.map().brier())});
      }
    }
  }
  return table;
}

Series series_of(const Reliability& reliability, const std::string& name) {
  Series series{name, {}};
  for (const Reliability::Bin& bin : reliability.bins) {
    if (bin.scans > 0.0) series.points.emplace_back(bin.given / bin.scans, bin.came / bin.scans);
  }
  return series;
}

TextTable table_of(const Reliability& reliability, const std::string& title) {
  TextTable table{title, {"given", "mean", "came true", "scans"}, {}};
  for (std::size_t i = 0; i < reliability.bins.size(); ++i) {
    const Reliability::Bin& bin = reliability.bins[i];
    const double low = 0.1 * static_cast<double>(i);
    table.rows.push_back({text_of(low) + "–" + text_of(low + 0.1), text_of(bin.given / bin.scans),
                          text_of(bin.came / bin.scans), text_of(bin.scans)});
  }
  return table;
}

void add_figures(Report& report, const std::string& place, const VerdictPart& part) {
  const double wrong = part.once_wrong();
  const double right = part.runs() - wrong;
  const auto add = [&](const std::string& what, double value, const std::string& unit, std::optional<Target> target) {
    report.figures.push_back({place + ": " + what, value, unit, target});
  };
  add("wrong poses called right for more than 5 s", share_of(part.wrong_called_right(), wrong), "",
      Target{.most = 0.01});
  add("wrong poses called right for more than 5 s, 95 % upper bound", wilson_upper(part.wrong_called_right(), wrong),
      "", std::nullopt);
  add("right poses called lost", share_of(part.right_called_lost(), right), "", Target{.most = 0.02});
  add("right poses called lost, 95 % upper bound", wilson_upper(part.right_called_lost(), right), "", std::nullopt);
  add("Brier score of P(pose right)", part.pose().brier(), "", std::nullopt);
  add("Brier score of P(map wrong)", part.map().brier(), "", std::nullopt);
  add("wrong poses recovered within 30 s of driving", share_of(part.recovered_in(kRecovery_s), wrong), "",
      std::nullopt);
  add("wrong poses recovered at all", share_of(part.recovered_in(HUGE_VAL), wrong), "", std::nullopt);
  add("wrong poses right again, and called so, within 30 s of driving",
      share_of(part.called_right_again_in(kRecovery_s), wrong), "", std::nullopt);
  add("half of the wrong poses recovered after driving", part.recovery_quantile_s(0.5), "s", std::nullopt);
  add("ambiguous runs", part.ambiguous(), "", std::nullopt);
  add("runs once wrong", wrong, "", std::nullopt);
  add("runs never wrong", right, "", std::nullopt);
  add("time called right in runs never wrong", part.called_right_when_right(), "", std::nullopt);
}

/// What is asked for depends on whether anyone could know the place; of all places together.
void add_ambiguity(Report& report, const std::vector<Outcome>& outcomes) {
  const VerdictPart clear{outcomes, [](const Outcome& outcome) { return !is_ambiguous(outcome); }};
  const VerdictPart ambiguous{outcomes, is_ambiguous};
  const auto add = [&](const std::string& what, double value, std::optional<Target> target) {
    report.figures.push_back({what, value, "", target});
  };
  add("unambiguous places: wrong poses recovered within 30 s of driving",
      share_of(clear.recovered_in(kRecovery_s), clear.once_wrong()), Target{.least = 0.95});
  add("unambiguous places: wrong poses recovered within 30 s of driving from when the path is unambiguous",
      share_of(clear.recovered_in_after_unique(kRecovery_s), clear.once_wrong()), std::nullopt);
  add("unambiguous places: runs once wrong", clear.once_wrong(), std::nullopt);
  add("ambiguous places: wrong poses never called right for more than 5 s",
      1.0 - share_of(ambiguous.wrong_called_right(), ambiguous.once_wrong()), Target{.least = 0.99});
  add("ambiguous places: runs once wrong", ambiguous.once_wrong(), std::nullopt);
}

}  // namespace

Report verdict_report(const std::vector<Outcome>& outcomes) {
  Report report;
  add_ambiguity(report, outcomes);
  for (const std::string place : {"hall", "depot"}) {
    const VerdictPart part{outcomes, [&](const Outcome& outcome) { return outcome.label("place") == place; }};
    if (part.runs() == 0.0) continue;  // not asked for
    const VerdictPart undisturbed{outcomes, [&](const Outcome& outcome) {
                                    return outcome.label("place") == place &&
                                           outcome.label("event") == name_of(PoseEvent::kNothing);
                                  }};
    add_figures(report, place, part);
    report.figures.push_back({place + ": undisturbed runs whose pose became wrong",
                              share_of(undisturbed.once_wrong(), undisturbed.runs()), ""});
    for (const double range_m : kVerdictRanges_m) {
      report.figures.push_back({place + ": tiles proven when lived in, " + text_of(range_m) + " m",
                                mean_tiles(outcomes, place, range_m), ""});
    }
    report.tables.push_back(table_of(outcomes, place));
    const Reliability pose = part.pose();
    const Reliability map = part.map();
    report.tables.push_back(table_of(pose, place + ": P(pose right)"));
    report.tables.push_back(table_of(map, place + ": P(map wrong)"));
    report.charts.push_back({place + ": reliability",
                             "probability given",
                             "share that came true",
                             {series_of(pose, "pose right"), series_of(map, "map wrong")},
                             true});
  }
  return report;
}

}  // namespace deltamap::experiments
