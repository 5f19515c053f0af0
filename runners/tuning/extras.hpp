#pragma once

#include <any>
#include <string_view>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/stages.hpp"

/// Extras of a tuning: optional simulations that follow the proof of the tuned values. Their results are not
/// proven.
namespace zerocount::tuning {

/// Results of the extras that ran, and the parts of the answer that were left out.
struct Extras {
  /// Results that Extra::run returned. TuneAnswer::extra() finds one by its type.
  std::vector<std::any> found{};
  std::vector<LeftOut> left_out{};
};

/// A tuned axis: study, tuned values and their proof, with the effort that the extras of the answer may
/// spend.
struct TunedAxis : Space {
  StudySearch& search;  ///< Search that found the values; its machines are simulated by the extras.
  /// File with the results of the searches for other controls, from which an interrupted tuning resumes.
  TuningJournal& journal;
  const Values& values;  ///< [free parameter] Tuned values.
  const Proof& proof;    ///< Proof that the tuned values meet the goals, or the attempt at one.
  bool is_met{false};
  Extras& extras;
  /// Result of the search. The numbers of points and trials of searches for other controls are added to it.
  SearchResult& searched;
  /// Study with the tuned values, on the machines of the search.
  study::Study tuned{search.candidate(values)};
  RestPlan plan{};
  std::int64_t later{0};  ///< Number of trials planned for the extras after the current one.

  /// Number of trials that one point takes: the planned machines times the trials of each.
  std::int64_t trials_of_point() const { return plan.machines * search.machines().trials_each; }
  /// Machines on which the extras simulate: all machines of the search or, with a budget, the planned ones.
  trials::Replicates machines() const;
  /// Study with the tuned values, on the machines of machines().
  /// @param overrides further "key=value" changes
  study::Study on_machines(std::vector<std::string> overrides = {}) const;
  /// Index in Aim::claims of the claim (goal in a setting) that is missed most, if the planned machines miss
  /// any. Nothing if they meet all.
  /// @param study the tuned study, or the study with other values
  /// @param change changes the parameters of each drawn trial; null: no change
  std::optional<std::size_t> lost_claim(const study::Study& study, const Change* change) const;
  /// Effort for one of `parts` equal parts of an extra. With a budget, they share what remains after the
  /// trials of the later extras are set aside. Without a budget: `by_default` trials.
  trials::Effort one_of_parts(double parts, std::int64_t by_default) const;
};

/// Cost of an extra in simulations, from which its machines are planned.
struct ExtraCost {
  bool applies{true};  ///< Whether the extra makes sense for this answer; false: it is not made.
  /// Number of points (sets of values) that are each simulated on the planned machines.
  std::int64_t points{0};
  std::int64_t searches{0};  ///< Number of trials that the smallest searches of the extra take together.
  /// Number of trials that the maps of the extra take. They are planned only if the other extras leave
  /// enough.
  std::int64_t maps{0};
  std::int64_t trials{0};  ///< Maximum number of trials that the extra takes by the plan.
  double usual_part{1.0};  ///< Fraction of `trials` that must be affordable; otherwise the extra is left out.
};

struct Tuning;

/// An optional part of the answer of a tuning, such as the causes of failures.
struct Extra {
  std::string_view name;        ///< Name of the extra in the option --extras.
  std::string_view question{};  ///< Heading on an HTML page, as a question.
  std::string_view part{};      ///< Name of the extra in the list of parts that were left out; empty: `name`.
  /// Returns why a study cannot have this extra, as text of a refused option; empty if it can. Null: every
  /// study can have it.
  std::string (*refusal)(const study::Study& study, bool with_page){nullptr};
  /// Function that returns the cost of the extra for a tuned axis.
  ExtraCost (*cost)(const TunedAxis&);
  /// Computes the extra. TuneAnswer::extra() finds the returned value by its type. Parts for which the effort
  /// was not enough are added to the list of parts left out.
  /// @throws trial::Interrupted, trials::Spent
  std::any (*run)(TunedAxis&);
  /// Adds the result to the description of the answer; null: the extra has no description.
  void (*describe)(document::Description<Tuning>&){nullptr};
};

/// Computes the wanted extras one after another.
///
///     plan: choose the number of machines per point so that the budget is enough for all extras
///     for each extra:
///       if it costs more than what is left: leave it out, so that later ones may fit
///       tell the remaining time; run it; ready(extra)
///       if the effort ended: list it as left out
///       if a stop is requested: leave out this and all later extras
void make_extras(const std::vector<const Extra*>& wanted, TunedAxis& axis, bool quiet,
                 status::StatusLine& line, const std::function<void(const Extra&)>& ready);

}  // namespace zerocount::tuning
