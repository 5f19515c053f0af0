#pragma once

#include <string>
#include <vector>

#include "experiments/distributions/profile_form.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// A profile that the manifest asks for, to be realised once the seed is known.
struct ProfileRequest {
  std::size_t row{0};  ///< of the table of parameters
  ProfileForm form;
  Per per{Per::study};  ///< study or rig
  Place place;          ///< where it stands, and its path, for messages
  std::string path;
};

/// What reading a manifest builds up.
struct Reading {
  Problems& problems;
  StudyPlan& plan;                         ///< gets the distributions
  std::int64_t version;                    ///< of the results files whose defaults are taken
  bool has_rigs{false};                    ///< the study has the key `rigs`
  std::vector<ProfileRequest> profiles{};  ///< [index of a value of kind profile]
  std::vector<std::string> warnings{};     ///< what is allowed but may surprise
};

/// Reports the realised profiles whose values leave the range of their parameter anywhere on a rotor.
void check_profiles(const Reading& reading);

/// A value that could not be read: NaN, so that no later check fires on it.
Value unreadable_value();

/// The value of the parameter in row `row`: a number, a word, a distribution or a profile, checked against
/// the range that the parameter allows. What is wrong is reported, and an unreadable value returned.
Value read_value(const Field& field, std::size_t row, Reading& reading);

/// `number` as a value of the parameter, checked likewise; `field` is where it comes from.
Value checked_number(const Field& field, std::size_t row, double number, Reading& reading);

}  // namespace zerocount
