#pragma once

#include <any>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/stages.hpp"

/// What follows the proof of a tuning, by simulation; none of it is proven.
namespace zerocount::tuning {

/// The extras that were made, and what was left out.
struct Extras {
  std::vector<std::any> found{};
  std::vector<LeftOut> left_out{};
};

/// A tuned axis, and what its extras may spend.
struct TunedAxis : Space {
  StudySearch& search;     ///< whose machines are simulated
  TuningJournal& journal;  ///< of the searches for other controls
  const Values& values;    ///< of the free parameters
  const Proof& proof;      ///< of them
  bool is_met{false};
  Extras& extras;
  SearchResult& searched;  ///< gets the points and trials of searches for other controls
  study::Study tuned{search.candidate(values)};  ///< on the units of the search
  RestPlan plan{};
  std::int64_t later{0};  ///< trials that the extras after this one take of the plan

  /// Trials of a point on the planned units.
  std::int64_t trials_of_point() const { return plan.units * search.units().trials_each; }
  /// All units of the search, with a budget those of the plan.
  trials::Replicates units() const;
  /// The tuned study on units().
  study::Study on_units(std::vector<std::string> overrides = {}) const;
  /// The worst claim (Aim::claims) that the first planned units do not meet; nothing if they meet all.
  /// @param study tuned, or with other values @param change null: none
  std::optional<std::size_t> lost_claim(const study::Study& study, const Change* change) const;
  /// One of so many parts of what a budget leaves beside the later extras; without a budget `by_default`
  /// trials.
  trials::Effort one_of_shares(double parts, std::int64_t by_default) const;
};

/// What an extra takes.
struct ExtraCost {
  bool applies{true};        ///< to this answer
  std::int64_t points{0};    ///< that share the planned units
  std::int64_t searches{0};  ///< trials of its smallest searches
  std::int64_t maps{0};      ///< trials that are planned only where the others leave them
  std::int64_t trials{0};    ///< at most, by the plan
  double usual_part{1.0};    ///< of these, which must be affordable
};

struct Tuning;

/// A part of the answer that a user may want or not.
struct Extra {
  std::string_view name;        ///< in --extras
  std::string_view question{};  ///< its heading on a page
  std::string_view part{};      ///< its name where it is left out; empty: `name`
  /// Why a study cannot have it, in the words of a refused option; empty if it can. Null: every study can.
  std::string (*refusal)(const study::Study& study, bool with_page){nullptr};
  ExtraCost (*cost)(const TunedAxis&);
  /// Makes it; what it returns is found by TuneAnswer::extra(). Parts that it leaves out stand in the answer.
  /// @throws trial::Interrupted, trials::Spent
  std::any (*run)(TunedAxis&);
  void (*describe)(document::Description<Tuning>&){nullptr};
};

/// Makes the wanted extras.
///
///     plan: so many units for each point that the budget is enough for all of them
///     for each:
///       what it takes is more than what is left: it is left out, so that later ones may fit
///       tell what remains; run it; ready(extra)
///       the effort ended: it is left out, and named
///       a stop is requested: it and all later ones are left out
void make_extras(const std::vector<const Extra*>& wanted, TunedAxis& axis, bool quiet,
                 status::StatusLine& line, const std::function<void(const Extra&)>& ready);

}  // namespace zerocount::tuning
