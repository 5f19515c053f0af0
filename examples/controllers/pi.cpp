// The controller of pi.c in C++.

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

#include <zerocount/controller.h>

namespace {

enum Parameter { kp, ki, zone, parameter_count };

constexpr zerocount_parameter parameters[parameter_count] = {
    {"kp", "N m/count", "proportional gain", 0.0, 0.0, 1e6},
    {"ki", "N m/count", "integral gain of the trapezoidal rule", 3.85e-5, 0.0, 1e6},
    {"zone", "count", "largest |error| with which the integral changes", 1e12, 0.0,
     std::numeric_limits<double>::infinity()},
};

class Pi {
 public:
  explicit Pi(double integral) : integral_(integral) {}

  double step(const zerocount_setup& setup, const zerocount_sample& now) {
    const double* p = setup.parameters;
    if (std::abs(now.error) <= p[zone]) {
      integral_ = std::clamp(integral_ + p[ki] * (now.error + last_error_), setup.lowest_torque,
                             setup.highest_torque);
    }
    last_error_ = now.error;
    return integral_ + p[kp] * now.error;
  }

 private:
  double integral_;         // N m
  double last_error_{0.0};  // counts
};
static_assert(std::is_trivially_copyable_v<Pi> && std::is_trivially_destructible_v<Pi>);

int start(void* state, const zerocount_setup* setup, char*, size_t) {
  new (state) Pi(setup->initial_integral);
  return 0;
}

double step(void* state, const zerocount_setup* setup, const zerocount_sample* now) {
  return static_cast<Pi*>(state)->step(*setup, *now);
}

constexpr zerocount_controller controller = {
    sizeof(zerocount_controller),
    ZEROCOUNT_CONTROLLER_ABI,
    "pi",
    "1.0",
    parameters,
    parameter_count,
    sizeof(Pi),
    start,
    step,
};

}  // namespace

const zerocount_controller* zerocount_controller_entry() {
  return &controller;
}
