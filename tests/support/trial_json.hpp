#pragma once

#include <istream>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// The parameters of a trial as the JSON text that high_precision_trial.py reads: what the outside judges
/// know of. Numbers read back to the same double.
std::string to_json(const trial::TrialParameters& parameters);

/// The inverse of to_json.
trial::TrialParameters trial_from_json(std::istream& in);

/// The sample records of a trial from its CSV columns
/// k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh, depth,mode. What these do not say is
/// left at its default, and the motor's torque not a number.
/// @throws std::runtime_error where the header or a row is not that.
std::vector<trial::SampleRecord> read_trace_csv(std::istream& in);

}  // namespace zerocount::testing
