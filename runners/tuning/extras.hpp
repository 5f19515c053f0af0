#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runners/status/status.hpp"
#include "runners/tuning/search/other_controls.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/tuner.hpp"

namespace zerocount::tuning {

/// Makes the extras of a tuning.
///
///     plan: so many units for each point that the budget is enough for all wanted extras
///     for each wanted extra, in the order of Extra:
///       what it takes is more than what is left: it is left out, so that later ones may fit
///       tell what remains; make it; ready(extra)
///       the effort ended: it is left out, and named
///       a stop is requested: it and all later ones are left out
class ExtrasMaker {
 public:
  struct Context {
    const study::Study& study;  ///< that was tuned
    const TuneSettings& settings;
    StudySearch& search;     ///< whose machines are simulated
    TuningJournal& journal;  ///< of the searches for other controls
    const trials::Effort& effort;
    double speed;           ///< by which a budget is planned, trials/s; infinite without a limit of time
    double measured_speed;  ///< by which times are estimated, trials/s; 0 where nothing was measured
    std::function<double()> elapsed;  ///< s
    status::StatusLine& line;
  };

  /// @param answer with the tuned values and their proof; gets the extras
  ExtrasMaker(const Context& context, TuneAnswer& answer);

  void make();

 private:
  void make(Extra extra);
  void find_delay();
  void add_retuning();
  void retune(const LifeInterval& interval, const trials::Effort& effort, std::vector<TunedValues>& tuned);
  SearchResult search_from(const study::Study& study, const std::vector<study::FreeParameter>& free,
                           const trials::Effort& effort, std::vector<Values> starts);
  void add_controls();
  void add_control(const OtherControl& control, const trials::Effort& effort,
                   std::vector<TunedValues>& tuned);
  void judge_control(const study::Study& study, const std::vector<study::FreeParameter>& free,
                     const Values& values, const trials::Effort& effort, Alternative& alternative) const;
  bool ended(const std::function<void()>& work) const;
  void leave_out(Extra extra, const std::string& part);
  std::int64_t trials_of(Extra extra) const;
  double seconds_of(Extra extra) const;
  bool fits(Extra extra) const;
  std::int64_t least_of_controls() const;
  trials::Replicates units_of_limits() const;
  study::Study tuned_for_limits(std::vector<std::string> overrides = {}) const;
  trials::Effort one_of_shares(double parts) const;
  bool has_budget() const { return of_.settings.budget.trials || of_.settings.budget.seconds; }
  bool is_met() const { return answer_.status == goal::Status::met; }
  bool wants(Extra extra) const;
  std::int64_t points_of_ages() const;
  std::int64_t points_of_limits() const;
  trials::Replicates units_of_ages() const;

  Context of_;
  TuneAnswer& answer_;
  std::vector<OtherControl> controls_;
  std::vector<LifeInterval> intervals_;           ///< for which values are tuned again
  std::vector<std::int64_t> least_of_intervals_;  ///< least_trials_of_retuning() of each
  study::Study tuned_;
  RestPlan plan_;
  TunedStudy details_;
};

}  // namespace zerocount::tuning
