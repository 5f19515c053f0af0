#pragma once

#include <cstdint>
#include <string_view>

#include "experiments/study/study_fwd.hpp"

namespace zerocount::study {

/// The lowest value of a parameter that a design must cover at a design point under a condition.
struct LowEnd {
  enum class Kind : std::uint8_t {
    number,   ///< the parameter is one number
    support,  ///< low end of its distribution
    tail,     ///< 0.1 % quantile of a normal, truncated normal or lognormal distribution
    profile  ///< the parameter varies along the rotor: use the minimum of the trial's profile; `value` is not
             ///< set
  };
  Kind kind{Kind::number};
  double value{0.0};  ///< in the parameter's unit
};

/// @param parameter name of a positive physical value, such as friction.k1.
LowEnd low_end(const Study& study, std::int64_t point, std::string_view parameter,
               std::int64_t condition = 0);

}  // namespace zerocount::study
