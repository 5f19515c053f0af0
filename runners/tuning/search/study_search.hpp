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
#include "runners/tuning/machine_runs/loop_examiner.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/race/search_space.hpp"
#include "runners/tuning/search/tuning_journal.hpp"

namespace zerocount::tuning {

/// Values of the free parameters in the manifest.
Values values_in_manifest(const study::Study& study, std::span<const study::FreeParameter> free);

/// Number of trials, in all settings together, that decide whether a machine meets the goals. If no goal
/// asks for machines: one trial in each setting.
std::int64_t trials_of_machine(const study::Study& study);

/// Number of trials of a machine in the search, in all settings together: trials_of_machine() with an
/// upper limit for each setting.
std::int64_t search_trials_of_machine(const study::Study& study);

/// The examined point closest to the wanted margins, for a search in which no point keeps them.
struct NearestPoint {
  Values values;
  SmallestMargins margins;  ///< Smallest margins of all examined machines.
};

/// Search for the best values of the parameters `free`. All other values are those of the study.
class StudySearch {
 public:
  /// @param size its max_machines must be a multiple of the number of worlds
  /// @param effort effort of the tuning; its end also stops the examination of finalists
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, const SearchSize& size,
              TuningJournal& journal, trials::Effort effort);

  /// Runs the search.
  /// @param starts candidates to race first, besides the values of the manifest
  /// @throws trial::Interrupted
  SearchResult run(const SearchSettings& settings, std::vector<Values> starts = {});

  /// Study with these values on the machines of the search. The values must be allowed together.
  study::Study candidate(const Values& values) const { return at_values(base_, free_, values).value(); }
  /// Study with these values on the machines whose margins are examined. The values must be allowed together.
  /// There are 2048 of these machines, however small the search is.
  study::Study examined_candidate(const Values& values) const { return examined_if_allowed(values).value(); }
  /// Study of examined_candidate(); nothing if these values are not allowed together.
  std::optional<study::Study> examined_if_allowed(const Values& values) const {
    return at_values(examined_base_, free_, values);
  }
  /// Why the first examined point was not allowed, if no examined point was; empty otherwise.
  std::string refusal_of_all() const;
  /// The examined point with the smallest LoopExaminer::shortfall; nothing if no point is allowed. If there
  /// are many points, about a thousand of them are compared.
  /// @throws trial::Interrupted
  std::optional<NearestPoint> nearest() const;
  /// Whether values keep the margins on the machines that are critical so far.
  /// @param slides whether some machine slides
  bool may_keep(const Values& values, bool slides) const;
  const LoopExaminer& examiner() const { return examiner_; }
  LoopExaminer& examiner() { return examiner_; }
  const trials::Replicates& machines() const { return machines_; }
  /// Points whose margins were examined.
  const std::vector<Values>& examined() const { return examined_; }
  /// Number of trials that this run simulated. Trials of an earlier, interrupted run are not counted.
  std::int64_t simulated() const { return simulated_; }
  /// Time that the trials of simulated() took, s.
  double simulation_seconds() const { return simulation_seconds_; }

 private:
  void evaluate(std::span<Candidate* const> candidates, std::int64_t to);
  std::vector<bool> admissible(std::span<const Candidate> candidates);
  /// LoopExaminer::shortfall() of each of these values; infinity for values that are not allowed together.
  /// @param slides whether machines slide
  std::vector<double> shortfalls_of(std::span<const Values> values, bool slides,
                                    const std::stop_token& stop) const;
  bool verified(const Candidate& candidate);

  /// Inputs to the margins of a candidate: its values, and whether it slid.
  using Examination = std::pair<Values, bool>;
  static Examination examination_of(const Candidate& candidate) {
    return {candidate.values, has_slid(candidate.machines)};
  }

  const study::Study& study_;
  std::vector<study::FreeParameter> free_;
  SearchSize size_;
  trials::Replicates machines_;
  study::Study base_;
  trials::Replicates examined_machines_;
  study::Study examined_base_;
  LoopExaminer examiner_;
  TuningJournal& journal_;
  std::set<Examination> may_keep_;  ///< Examinations for which may_keep() was true.
  std::set<Examination> keeps_;     ///< Examinations that keep the margins on all machines.
  std::vector<Values> examined_;
  bool some_slid_{false};
  std::int64_t simulated_{0};
  double simulation_seconds_{0.0};
  trials::Effort effort_;
  std::stop_token stop_;  ///< Stop request of the running search.
};

/// Another control for the same axis.
struct OtherControl {
  std::string name;                          ///< "controller.kd = 0", "observer added"
  std::vector<std::string> zero;             ///< Free parameters of the study that are fixed at 0.
  std::vector<std::string> overrides;        ///< "key=value", including the zeros.
  std::vector<study::FreeParameter> free{};  ///< Parameters to be tuned.
};

/// Sets of free parameters that can be 0 together, as indices in `free`. Each set is a control with fewer
/// blocks: every kp or kd whose range begins at 0 alone, and all of them together. Each set leaves at least
/// one parameter free.
std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free);

/// Controls with which a tuning is compared: one for each of zero_sets(), and one with a disturbance observer
/// added to the PID law if the study has none. Controls with fewer free parameters come first.
std::vector<OtherControl> other_controls(const study::Study& study);

/// Values of a tuned control by the names of its parameters, including the fixed ones.
using TunedValues = std::map<std::string, double>;

/// Starts for the search of a control, one from each tuned control. A parameter that the tuned control lacks
/// starts at the low end of its range, where an added block, such as an observer, has nearly no effect. So a
/// control that has all blocks of a tuned one is worse than this one only by chance.
/// @param free free parameters of the control
std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free);

}  // namespace zerocount::tuning
