#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runners/trials/effort.hpp"
#include "runners/tuning/worst_machines/machine_box.hpp"
#include "runners/tuning/worst_machines/machine_failures.hpp"

namespace zerocount::tuning {

/// Trials of a machine at each stage of a race, from its first one on: the last stage decides.
constexpr std::array<std::int64_t, 3> stage_trials{4, 16, 64};
/// Machines that a race keeps.
constexpr std::size_t survivors = 8;

/// Keeps the worst of the points, the worst first. After each stage a part of those that have not run all
/// trials goes on, by the trials that all of them have run: of it those that do worse there than the mildest
/// point that is kept so far, which they would replace.
/// @throws trial::Interrupted, trials::Spent
void race(std::vector<BoxPoint>& points, const MachineBox& box, const MachineFailures& failures,
          const trials::Effort& effort);

}  // namespace zerocount::tuning
