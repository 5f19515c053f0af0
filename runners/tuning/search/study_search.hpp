#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/race/search_space.hpp"
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
  /// @param effort of the tuning: its end stops what a search examines at last
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, const SearchSize& size,
              TuningJournal& journal, trials::Effort effort);

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
  std::set<Examination> may_keep_;  ///< by may_keep()
  std::set<Examination> keeps_;     ///< on all machines
  std::vector<Values> examined_;
  bool some_slid_{false};
  std::int64_t simulated_{0};
  double simulation_seconds_{0.0};
  trials::Effort effort_;
  std::stop_token stop_;  ///< of the search
};

/// Another control for the same axis.
struct OtherControl {
  std::string name;                          ///< "controller.kd = 0", "observer added"
  std::vector<std::string> zero;             ///< free parameters of the study that are 0
  std::vector<std::string> overrides;        ///< "key=value", these zeros among them
  std::vector<study::FreeParameter> free{};  ///< to be tuned
};

/// The sets of free parameters that can be 0 together, each a control with fewer blocks: kp or kd where their
/// ranges begin there, and both. Some parameter stays free in each.
std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free);

/// The controls that a tuning is compared with: kp or kd at 0 where their ranges begin there, both, and a
/// disturbance observer beside the PID law where the study has none. Those with fewer free parameters come
/// first.
std::vector<OtherControl> other_controls(const study::Study& study);

/// The values of a tuned control by the names of its parameters, those that it fixes included.
using TunedValues = std::map<std::string, double>;

/// Starts of the search for a control: each tuned control, where this one has all its blocks with the added
/// ones nearly without effect, so that this control is worse than the other only by chance; else what it has
/// of the other.
/// @param free parameters of the control. An observer has nearly no effect at the low end of its bandwidth.
std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free);

}  // namespace zerocount::tuning
