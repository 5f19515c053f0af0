#pragma once

#include <any>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/tune_answer.hpp"
#include "runners/tuning/tune_plan.hpp"

/// What follows the proof of a tuning, by simulation; none of it is proven.
namespace zerocount::tuning {

/// What `tune` found so far, as its answer shows it.
struct Tuning {
  const TuneAnswer& answer;
  const study::Study& study;     ///< that was tuned
  std::filesystem::path output;  ///< the results file of the proof
  bool drawn{false};             ///< with figures
  bool is_of_file{false};        ///< nothing was searched: the proof was made before
};

/// A tuned axis and the effort that its extras may spend.
struct TunedAxis {
  const study::Study& study;  ///< that was tuned
  StudySearch& search;        ///< whose machines are simulated
  TuningJournal& journal;     ///< of the searches for other controls
  trials::Effort effort;
  double speed;           ///< by which a budget is planned, trials/s; infinite without a limit of time
  double measured_speed;  ///< by which times are estimated, trials/s; 0 where nothing was measured
  std::function<double()> elapsed;                     ///< s
  TuneAnswer& answer;                                  ///< with the tuned values and their proof
  study::Study tuned{search.candidate(answer.gains)};  ///< on the units of the search
  RestPlan plan{};
  std::int64_t later{0};  ///< trials that the extras after this one take of the plan

  bool has_budget() const { return answer.budget.trials || answer.budget.seconds; }
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
  /// Whether the work ended within the effort, and without an interruption.
  bool ended(const std::function<void()>& work) const;
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

/// A part of the answer that a user may want or not.
struct Extra {
  std::string_view name;      ///< in --extras
  std::string_view question;  ///< its heading on a page
  std::string_view part{};    ///< its name where it is left out; empty: `name`
  /// Why a study cannot have it, in the words of a refused option; empty if it can. Null: every study can.
  std::string (*refusal)(const study::Study& study, bool with_page){nullptr};
  ExtraCost (*cost)(const TunedAxis&);
  /// Makes it; what it returns is found by TuneAnswer::extra(). Parts that it leaves out stand in the answer.
  /// @throws trial::Interrupted, trials::Spent
  std::any (*run)(TunedAxis&);
  void (*describe)(document::Description<Tuning>&);
};

/// Names a part of an extra that is left out.
void leave_out(TuneAnswer& answer, std::string_view extra, std::string part);

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
