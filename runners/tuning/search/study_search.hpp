#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/search/tuning_journal.hpp"
#include "runners/tuning/units/loop_examiner.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// The values of the free parameters in the manifest.
Values values_in_manifest(const study::Study& study, std::span<const study::FreeParameter> free);

/// Trials of a machine, under all conditions together, that tell whether it meets the goals; one under each
/// condition where no goal asks for machines.
std::int64_t trials_of_machine(const study::Study& study);

/// Those of the search, which takes fewer.
std::int64_t search_trials_of_machine(const study::Study& study);

/// The point that comes nearest to the wanted margins, where none keeps them.
struct NearestPoint {
  Values values;
  SmallestMargins margins;  ///< of all examined machines
};

/// The search for the best values of `free`, with the other values of the study.
class StudySearch {
 public:
  /// @param size whose largest number of units is a multiple of the worlds
  /// @param elapsed s that the tuning took so far, for the journal
  /// @param effort of the tuning: its end stops what a search examines at last
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, const SearchSize& size,
              TuningJournal& journal, std::function<double()> elapsed, trials::Effort effort);

  /// @param starts candidates of the first generation beside the manifest's values
  /// @throws trial::Interrupted
  SearchResult run(const SearchSettings& settings, std::vector<Values> starts = {});

  /// The study with these values, which are allowed together, on the units of the search.
  study::Study candidate(const Values& values) const { return at_values(base_, free_, values).value(); }
  /// The same on the machines whose margins are examined: 2048, however small the search is.
  study::Study examined_candidate(const Values& values) const { return examined_if_allowed(values).value(); }
  /// Nothing where such values together are not allowed.
  std::optional<study::Study> examined_if_allowed(const Values& values) const {
    return at_values(examined_base_, free_, values);
  }
  /// Why the first examined point was not allowed, where none of them was; empty otherwise.
  std::string refusal_of_all() const;
  /// The examined point with the least LoopExaminer::shortfall, of many about a thousand; nothing without
  /// points that are allowed.
  /// @throws trial::Interrupted
  std::optional<NearestPoint> nearest() const;
  /// Whether values keep the margins on the machines that are critical so far. @param slides whether some
  /// slide
  bool may_keep(const Values& values, bool slides) const;
  const LoopExaminer& examiner() const { return examiner_; }
  LoopExaminer& examiner() { return examiner_; }
  const trials::Replicates& units() const { return units_; }
  const std::vector<Values>& examined() const { return examined_; }  ///< points whose margins were examined
  /// Trials that were simulated, and the time that they took, s; without those of an earlier run.
  std::int64_t simulated() const { return simulated_; }
  double simulation_seconds() const { return simulation_seconds_; }

 private:
  void evaluate(std::span<Candidate* const> candidates, std::int64_t to);
  std::vector<bool> admissible(std::span<const Candidate> candidates);
  /// @param slides whether machines slide
  std::vector<double> shortfalls_of(std::span<const Values> values, bool slides,
                                    const std::stop_token& stop) const;
  bool verified(const Candidate& candidate);

  /// What the margins of a candidate depend on: its values, and whether it slid.
  using Examination = std::pair<Values, bool>;
  static Examination examination_of(const Candidate& candidate) {
    return {candidate.values, has_slid(candidate.units)};
  }

  const study::Study& study_;
  std::vector<study::FreeParameter> free_;
  SearchSize size_;
  trials::Replicates units_;
  study::Study base_;
  trials::Replicates examined_units_;
  study::Study examined_base_;
  LoopExaminer examiner_;
  TuningJournal& journal_;
  std::function<double()> elapsed_;
  std::set<Examination> may_keep_;  ///< by may_keep()
  std::set<Examination> keeps_;     ///< on all machines
  std::vector<Values> examined_;
  bool some_slid_{false};
  std::int64_t simulated_{0};
  double simulation_seconds_{0.0};
  trials::Effort effort_;
  std::stop_token stop_;  ///< of the search
};

}  // namespace zerocount::tuning
