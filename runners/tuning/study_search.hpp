#pragma once

#include <functional>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include "analysis/tuning/search.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/loop_examiner.hpp"
#include "runners/tuning/tuning_journal.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Trials of a machine that tell whether it meets the goal; 1 where the goal does not ask for machines.
std::int64_t trials_of_machine(const study::Study& study);

/// The search for the best values of `free`, with the other values of the study.
class StudySearch {
 public:
  /// @param most_units machines of the search
  /// @param elapsed s that the tuning took so far, for the journal
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, std::int64_t most_units,
              TuningJournal& journal, std::function<double()> elapsed, const std::stop_token& stop);

  /// @throws trial::Interrupted
  SearchResult run(const SearchSettings& settings);

  /// The study with these values, on the units of the search.
  study::Study candidate(const Values& values) const;
  const LoopExaminer& examiner() const { return examiner_; }
  LoopExaminer& examiner() { return examiner_; }
  const Units& units() const { return units_; }
  std::int64_t examined() const { return examined_; }  ///< points whose margins were examined

 private:
  void evaluate(std::span<Candidate* const> candidates, std::int64_t to);
  std::vector<bool> admissible(std::span<const Candidate> candidates);
  bool verified(const Candidate& candidate);

  /// What the margins of a candidate depend on: its values, and whether it slid.
  using Examination = std::pair<Values, bool>;
  static Examination examination_of(const Candidate& candidate) {
    return {candidate.values, has_slid(candidate.units)};
  }

  const study::Study& study_;
  std::vector<study::FreeParameter> free_;
  Units units_;
  study::Study base_;
  LoopExaminer examiner_;
  TuningJournal& journal_;
  std::function<double()> elapsed_;
  std::set<Examination> may_keep_;  ///< on the machines that are critical so far
  std::set<Examination> keeps_;     ///< on all machines
  std::int64_t examined_{0};
  std::stop_token stop_;
};

}  // namespace zerocount::tuning
