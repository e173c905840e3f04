// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/verdict_report.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "experiments/pooled_runs.hpp"
#include "experiments/verdict/verdict_part.hpp"
#include "experiments/verdict/verdict_run.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRecovery_s = 30.0;

double share_of(double part, double whole) { return whole > 0.0 ? part / whole : std::nan(""); }

std::string of(double part, double whole) { return text_of(part) + " of " + text_of(whole); }

/// Of each run of a part: the tiles that its robot had learned before.
std::vector<double> proven_tiles(const std::vector<Outcome>& outcomes, const std::string& place, double range_m) {
  std::vector<double> tiles;
  for (const Outcome* run : runs_with(outcomes, {{"place", place}, {"range_m", text_of(range_m)}}))
    tiles.push_back(run->number("proven_tiles"));
  return tiles;
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

/// How sure a figure is that is made of the runs of a part.
template <typename Of>
Certainty certainty_of(const VerdictPart& part, Of&& of) {
  const auto figure = [&](const std::vector<std::size_t>& drawn) {
    std::vector<const Outcome*> chosen;
    chosen.reserve(drawn.size());
    for (const std::size_t run : drawn) chosen.push_back(part.chosen()[run]);
    return std::vector<double>{of(VerdictPart{std::move(chosen)})};
  };
  return certainties_of_runs(part.chosen().size(), figure).front();
}

/// The Brier score of all scans, by the sums of each run.
Figure brier_figure(const std::string& name, const VerdictPart& part,
                    const std::function<Reliability(const ScanTable&)>& reliability_of) {
  std::vector<Reliability> runs;
  for (const Outcome* run : part.chosen()) runs.push_back(reliability_of(run->scans));
  const auto brier = [&](const std::vector<std::size_t>& drawn) {
    Reliability all;
    for (const std::size_t run : drawn) {
      all.squared += runs[run].squared;
      all.scans += runs[run].scans;
    }
    return std::vector<double>{all.brier()};
  };
  std::vector<std::size_t> each;
  for (std::size_t run = 0; run < runs.size(); ++run) each.push_back(run);
  return {name, brier(each).front(), "", {}, "", certainties_of_runs(runs.size(), brier).front()};
}

/// Adds figures of one part to a report, with their certainty.
class FiguresOf {
 public:
  FiguresOf(Report& report, std::string where, const VerdictPart& part)
      : report_{report}, where_{std::move(where)}, part_{part} {}

  template <typename Of>
  void add(const std::string& what, Of&& of, const std::optional<Target>& target = {}, const std::string& unit = "") {
    report_.figures.push_back({where_ + what, of(part_), unit, target, "", certainty_of(part_, of)});
  }
  /// A count, or what is a bound itself.
  void add_plain(const std::string& what, double value) {
    report_.figures.push_back({where_ + what, value, "", {}, "", Certainty{.runs = part_.chosen().size()}});
  }
  void add_brier(const std::string& what, const std::function<Reliability(const ScanTable&)>& reliability_of) {
    report_.figures.push_back(brier_figure(where_ + what, part_, reliability_of));
  }

 private:
  Report& report_;
  std::string where_;
  const VerdictPart& part_;
};

double wrong_called_right(const VerdictPart& part) { return share_of(part.wrong_called_right(), part.once_wrong()); }
double recovered(const VerdictPart& part) { return share_of(part.recovered_in(kRecovery_s), part.once_wrong()); }

void add_figures(Report& report, const std::string& place, const VerdictPart& part) {
  const double wrong = part.once_wrong();
  const double right = part.runs() - wrong;
  FiguresOf figures{report, place + ": ", part};
  figures.add("wrong poses called right for more than 5 s", wrong_called_right, Target{.most = 0.01});
  figures.add_plain("wrong poses called right for more than 5 s, 95 % upper bound",
                    wilson_upper(part.wrong_called_right(), wrong));
  figures.add(
      "right poses called lost",
      [](const VerdictPart& p) { return share_of(p.right_called_lost(), p.runs() - p.once_wrong()); },
      Target{.most = 0.02});
  figures.add_plain("right poses called lost, 95 % upper bound", wilson_upper(part.right_called_lost(), right));
  figures.add_brier("Brier score of P(pose right)", [](const ScanTable& scans) { return pose_reliability(scans); });
  figures.add_brier("Brier score of P(map wrong)", [](const ScanTable& scans) { return map_reliability(scans); });
  figures.add("wrong poses recovered within 30 s of driving", recovered);
  figures.add("wrong poses recovered at all",
              [](const VerdictPart& p) { return share_of(p.recovered_in(HUGE_VAL), p.once_wrong()); });
  figures.add("wrong poses right again, and called so, within 30 s of driving",
              [](const VerdictPart& p) { return share_of(p.called_right_again_in(kRecovery_s), p.once_wrong()); });
  figures.add(
      "half of the wrong poses recovered after driving",
      [](const VerdictPart& p) { return p.recovery_quantile_s(0.5); }, {}, "s");
  figures.add_plain("ambiguous runs", part.ambiguous());
  figures.add_plain("runs once wrong", wrong);
  figures.add_plain("runs never wrong", right);
  figures.add("time called right in runs never wrong",
              [](const VerdictPart& p) { return p.called_right_when_right(); });
}

/// What is asked for depends on whether anyone could know the place; of all places together.
void add_ambiguity(Report& report, const std::vector<Outcome>& outcomes) {
  const VerdictPart clear{outcomes, [](const Outcome& outcome) { return !is_ambiguous(outcome); }};
  const VerdictPart ambiguous{outcomes, is_ambiguous};
  FiguresOf of_clear{report, "unambiguous places: ", clear};
  of_clear.add("wrong poses recovered within 30 s of driving", recovered, Target{.least = 0.95});
  of_clear.add("wrong poses recovered within 30 s of driving from when the path is unambiguous",
               [](const VerdictPart& p) { return share_of(p.recovered_in_after_unique(kRecovery_s), p.once_wrong()); });
  of_clear.add_plain("runs once wrong", clear.once_wrong());
  FiguresOf of_ambiguous{report, "ambiguous places: ", ambiguous};
  of_ambiguous.add(
      "wrong poses never called right for more than 5 s",
      [](const VerdictPart& p) { return 1.0 - wrong_called_right(p); }, Target{.least = 0.99});
  of_ambiguous.add_plain("runs once wrong", ambiguous.once_wrong());
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
    FiguresOf{report, place + ": ", undisturbed}.add(
        "undisturbed runs whose pose became wrong",
        [](const VerdictPart& p) { return share_of(p.once_wrong(), p.runs()); });
    for (const double range_m : kVerdictRanges_m) {
      const std::vector<double> tiles = proven_tiles(outcomes, place, range_m);
      report.figures.push_back({place + ": tiles proven when lived in, " + text_of(range_m) + " m",
                                mean_of(tiles),
                                "",
                                {},
                                "",
                                certainty_of_mean(tiles)});
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
