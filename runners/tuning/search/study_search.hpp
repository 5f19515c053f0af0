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

/// Values that the manifest gives to the free parameters.
Values values_in_manifest(const study::Study& study, std::span<const study::FreeParameter> free);

/// Number of trials of a machine, in all settings (conditions at ages) together, that decide whether it meets
/// the goals. If no goal asks for machines: one trial in each setting.
std::int64_t trials_of_machine(const study::Study& study);

/// Number of trials of a machine in the search, in all settings (conditions at ages) together:
/// trials_of_machine() with an upper limit for each setting.
std::int64_t search_trials_of_machine(const study::Study& study);

/// The examined set of values that comes closest to the wanted stability margins, for a search in which none
/// keeps them.
struct NearestPoint {
  Values values;
  SmallestMargins margins;  ///< Smallest stability margins of all examined machines with these values.
};

/// Searches for the best values of the parameters `free` of a study. All other values are those of the study.
class StudySearch {
 public:
  /// @param size size of the search; its max_machines must be a multiple of the number of worlds
  /// @param journal file with the results of simulated candidates, from which an interrupted tuning resumes
  /// @param effort effort of the tuning; its end also stops the examination of finalists
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, const SearchSize& size,
              TuningJournal& journal, trials::Effort effort);

  /// Runs the search for the best values.
  /// @param starts values of the free parameters to race first, besides those of the manifest
  /// @throws trial::Interrupted if a stop is requested
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
  /// Why the first examined set of values was not allowed, if none of the examined ones was; empty if some
  /// was.
  std::string refusal_of_all() const;
  /// The examined set of values with the smallest LoopExaminer::shortfall, which is closest to the wanted
  /// margins; nothing if no set is allowed. If there are many, about a thousand of them are compared.
  /// @throws trial::Interrupted if a stop is requested or the time is over
  std::optional<NearestPoint> nearest() const;
  /// Whether values keep the stability margins on the critical machines, those that violated margins of other
  /// values before.
  /// @param slides whether some machine slides with these values
  bool may_keep(const Values& values, bool slides) const;
  const LoopExaminer& examiner() const { return examiner_; }
  LoopExaminer& examiner() { return examiner_; }
  const trials::Replicates& machines() const { return machines_; }
  /// Sets of values whose stability margins were examined.
  const std::vector<Values>& examined() const { return examined_; }
  /// Number of trials that this run simulated. Trials of an earlier, interrupted run are not counted.
  std::int64_t simulated() const { return simulated_; }
  /// Time that the trials counted by simulated() took, s.
  double simulation_seconds() const { return simulation_seconds_; }

 private:
  void evaluate(std::span<Candidate* const> candidates, std::int64_t to);
  std::vector<bool> admissible(std::span<const Candidate> candidates);
  /// LoopExaminer::shortfall(), the distance from the wanted margins, for each set of values; infinity for
  /// values that are not allowed together.
  /// @param slides whether machines slide
  std::vector<double> shortfalls_of(std::span<const Values> values, bool slides,
                                    const std::stop_token& stop) const;
  bool verified(const Candidate& candidate);

  /// Inputs to an examination of stability margins: the values, and whether machines slide with them.
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
  std::set<Examination> may_keep_;  ///< Values (and whether machines slide) for which may_keep() was true.
  /// Values (and whether machines slide) that keep the margins on all machines.
  std::set<Examination> keeps_;
  std::vector<Values> examined_;
  bool some_slid_{false};
  std::int64_t simulated_{0};
  double simulation_seconds_{0.0};
  trials::Effort effort_;
  std::stop_token stop_;  ///< Token that requests a stop of the running search.
};

/// A control law with other blocks for the same axis, which is tuned for comparison.
struct OtherControl {
  std::string name;  ///< Text such as "controller.kd = 0" or "observer added".
  /// Names of the study's free parameters that are fixed at 0 in this control.
  std::vector<std::string> zero;
  /// "key=value" changes that turn the study's control into this one, including the zeros.
  std::vector<std::string> overrides;
  std::vector<study::FreeParameter> free{};  ///< Free parameters of this control, which are to be tuned.
};

/// Sets of free parameters that can be 0 together, as indices in `free`. Each set is a control with fewer
/// blocks: every kp or kd whose range begins at 0 alone, and all of them together. Each set leaves at least
/// one parameter free.
std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free);

/// Controls with which a tuning is compared: one for each of zero_sets(), and one with a disturbance observer
/// added to the PID law if the study has none. Controls with fewer free parameters come first.
std::vector<OtherControl> other_controls(const study::Study& study);

/// Values of a tuned control by the dotted paths of its parameters, including those that are fixed.
using TunedValues = std::map<std::string, double>;

/// Starting values for the search of the best parameters of a control law, one set from each control law
/// tuned before. A parameter that the tuned law lacks starts at the low end of its range, where an added
/// block, such as an observer, has nearly no effect. So a law that has all blocks of a tuned one is worse
/// than this one only by chance.
/// @param tuned values of the control laws tuned before
/// @param free free parameters of the control law
std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free);

}  // namespace zerocount::tuning
