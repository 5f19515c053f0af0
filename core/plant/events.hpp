#pragma once

#include <optional>

#include "core/friction/parameters.hpp"
#include "core/friction/spring.hpp"
#include "core/plant/motion_series.hpp"
#include "core/plant/parameters.hpp"

namespace zerocount {

/// What can happen to the contact within a step: each is a kink of the motion, and ends the step.
enum class Event {
  none,
  reversal,      ///< the elongation turns
  closure,       ///< the present branch ends
  creep_on,      ///< |σ| reaches the onset of creep
  creep_off,     ///< the hardening catches up with |σ|ⁿ/λ
  breakaway,     ///< the hook starts to slide
  velocity_zero  ///< ω = 0, which ends a slide, and may start one in a contact already loaded beyond
                 ///< breakaway
};

/// The first event within a step.
struct NextEvent {
  double time;  ///< s from the start of the step; its end where nothing happens
  Event event{Event::none};

  /// Takes `candidate` (s), if there is one, where it is not later than what is known.
  void offer(std::optional<double> candidate, Event what);
};

/// The contact at the start of a step.
struct StickingContact {
  const PlantParameters& plant;
  const FrictionParameters& friction;
  const HystereticSpring& spring;
  bool creeping;
  double creep_onset_torque;  ///< |σ| (N m) at which creep starts, while it is off
};

/// The first event of the pre-sliding motion within `step` (s).
NextEvent next_presliding_event(const PreslidingSeries& series, const StickingContact& contact, double step);

/// The end of the slide, if it is within `step` (s).
NextEvent next_sliding_event(const SlidingSeries& series, double step);

}  // namespace zerocount
