#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/variant.hpp"
#include "runners/tuning/race/search_space.hpp"

/// A tuned study at ages that its manifest need not name, on machines that its search did not use.
namespace zerocount::tuning {

/// A goal under a condition of the manifest, whatever the age.
struct ClaimOfLife {
  std::size_t goal{0};
  std::size_t condition{0};  ///< of Study::condition_names; 0 without conditions
};

/// The claims of a study with ages: goal by goal, each under every condition of the manifest.
std::vector<ClaimOfLife> claims_of_life(const study::Study& study);
/// " of goal 'small' under condition cold", as far as the study has several goals, and conditions.
std::string text_of(const study::Study& study, const ClaimOfLife& claim);

/// What machines of one age do.
struct AgeVerdict {
  double age{0.0};
  std::vector<goal::BoundedProportion> rates;  ///< [claim] of what the goal is about: machines, or moves
  std::vector<goal::Status> statuses;          ///< [claim]
  double criterion{0.0};                       ///< the largest of all claims; infinite for never
};

/// "[0,100000]": ages as the value of `ages.at`.
std::string ages_value(const std::vector<double>& ages);

/// Simulates a study at single ages on the same fresh machines, which have the same draws at every age.
class AgeRuns {
 public:
  /// @param study with ages @param units of one age, under all conditions together @param purpose another one
  /// gives other machines
  AgeRuns(const study::Study& study, const trials::Replicates& units, std::string_view purpose,
          trials::Effort effort);

  /// Why the study cannot be simulated at this age; empty if it can.
  std::string refusal_at(double age) const;

  /// @param values of the free parameters. The bounds are those of a verdict on the age alone
  /// @throws trial::Interrupted, trials::Spent; Failure (bad_input) where refusal_at() says why
  AgeVerdict at(double age, const std::vector<study::FreeParameter>& free, const Values& values) const;

  const study::Study& study() const { return study_; }
  std::int64_t units() const { return units_.count; }

 private:
  study::Study at_age(double age) const;

  const study::Study& study_;
  trials::Replicates units_;
  std::uint64_t seed_;
  trials::Effort effort_;
};

/// Trials of a unit at one age, of those that it has at all ages together.
std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each);

}  // namespace zerocount::tuning
