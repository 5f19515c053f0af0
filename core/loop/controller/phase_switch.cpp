#include "core/loop/controller/phase_switch.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::loop {

PhaseSwitch::PhaseSwitch(const CoarsePhaseParameters& rule, double sample_rate)
    : rule_(rule), dwell_(std::max(1.0, std::round(rule.fine_dwell * sample_rate))) {}

bool PhaseSwitch::update(const Feedback& fine, const Feedback& coarse) {
  const bool first = !last_coarse_count_.has_value();
  const double count_change = coarse.count - last_coarse_count_.value_or(coarse.count);
  last_coarse_count_ = coarse.count;

  const bool settled =
      std::abs(coarse.error) <= rule_.fine_within && std::abs(count_change) <= rule_.fine_rate;
  const std::int64_t settled_before = phase_ == ControlPhase::coarse ? settled_ : 0;
  settled_ = settled ? settled_before + 1 : 0;

  const ControlPhase next = next_phase(fine);
  const bool changed = next != phase_ && !first;
  phase_ = next;
  if (changed) ++changes_;
  return changed;
}

ControlPhase PhaseSwitch::next_phase(const Feedback& fine) const {
  if (phase_ == ControlPhase::fine)
    return std::abs(fine.error) > rule_.coarse_beyond ? ControlPhase::coarse : ControlPhase::fine;
  return static_cast<double>(settled_) >= dwell_ ? ControlPhase::fine : ControlPhase::coarse;
}

}  // namespace zerocount::loop
