#pragma once

#include <any>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/stages.hpp"

/// Extras of a tuning: simulations that follow the proof. Their results are not proven.
namespace zerocount::tuning {

/// Results of the extras that ran, and the parts that were left out.
struct Extras {
  std::vector<std::any> found{};  ///< Results of Extra::run.
  std::vector<LeftOut> left_out{};
};

/// A tuned axis, with the effort that its extras may spend.
struct TunedAxis : Space {
  StudySearch& search;     ///< Search whose machines are simulated.
  TuningJournal& journal;  ///< Journal of the searches for other controls.
  const Values& values;    ///< Tuned values of the free parameters.
  const Proof& proof;      ///< Proof of these values.
  bool is_met{false};
  Extras& extras;
  SearchResult& searched;  ///< Receives the points and trials of searches for other controls.
  study::Study tuned{search.candidate(values)};  ///< Tuned study on the machines of the search.
  RestPlan plan{};
  std::int64_t later{0};  ///< Planned trials of the extras after the current one.

  /// Number of trials of a point on the planned machines.
  std::int64_t trials_of_point() const { return plan.machines * search.machines().trials_each; }
  /// Machines of the extras: all machines of the search or, with a budget, the planned ones.
  trials::Replicates machines() const;
  /// The tuned study on machines().
  study::Study on_machines(std::vector<std::string> overrides = {}) const;
  /// Index in Aim::claims of the worst claim if the first planned machines miss any claim. Nothing if they
  /// meet all.
  /// @param study the tuned study, or the study with other values
  /// @param change changes each drawn trial; null: no change
  std::optional<std::size_t> lost_claim(const study::Study& study, const Change* change) const;
  /// Effort for one of `parts` equal parts of what the budget leaves after the later extras are paid. Without
  /// a budget: `by_default` trials.
  trials::Effort one_of_parts(double parts, std::int64_t by_default) const;
};

/// Cost of an extra.
struct ExtraCost {
  bool applies{true};        ///< Whether the extra is made for this answer.
  std::int64_t points{0};    ///< Number of points, each simulated on the planned machines.
  std::int64_t searches{0};  ///< Trials of its smallest searches.
  std::int64_t maps{0};      ///< Trials of maps. They are planned only if the other extras leave enough.
  std::int64_t trials{0};    ///< Maximum number of trials, by the plan.
  double usual_part{1.0};    ///< Fraction of `trials` that must be affordable for the extra to run.
};

struct Tuning;

/// An optional part of the answer.
struct Extra {
  std::string_view name;        ///< Name in the option --extras.
  std::string_view question{};  ///< Heading on a page.
  std::string_view part{};      ///< Name in the list of parts that were left out; empty: `name`.
  /// Returns why a study cannot have this extra, as text of a refused option; empty if it can. Null: every
  /// study can have it.
  std::string (*refusal)(const study::Study& study, bool with_page){nullptr};
  /// Returns the cost of the extra for an axis.
  ExtraCost (*cost)(const TunedAxis&);
  /// Makes the extra. TuneAnswer::extra() finds the returned value by its type. Parts that were left out are
  /// added to the answer.
  /// @throws trial::Interrupted, trials::Spent
  std::any (*run)(TunedAxis&);
  /// Describes the result in a document; null: it has no description.
  void (*describe)(document::Description<Tuning>&){nullptr};
};

/// Makes the wanted extras.
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
