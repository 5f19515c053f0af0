/* The paper's integral control with a proportional gain, and a conditional integrator:
 *
 *   I <- clamp(I + ki (e_k + e_{k-1})) where |e_k| <= zone; otherwise I stays;  u = I + kp e_k.
 *
 * The same as kp, ki and integrator_zone of the built-in controller, bit for bit. */

#include <math.h>

#include <zerocount/controller.h>

enum { KP, KI, ZONE };

static const zerocount_parameter parameters[] = {
    [KP] = {"kp", "N m/count", "proportional gain", 0.0, 0.0, 1e6},
    [KI] = {"ki", "N m/count", "integral gain of the trapezoidal rule", 3.85e-5, 0.0, 1e6},
    [ZONE] = {"zone", "count", "largest |error| with which the integral changes", 1e12, 0.0, INFINITY},
};

typedef struct {
  double integral;   /* N m */
  double last_error; /* counts */
} state;

static int start(void* memory, const zerocount_setup* setup, char* message, size_t message_size) {
  (void)message;
  (void)message_size;
  state* s = memory;
  s->integral = setup->initial_integral;
  return 0;
}

static double step(void* memory, const zerocount_setup* setup, const zerocount_sample* now) {
  state* s = memory;
  const double* p = setup->parameters;
  if (fabs(now->error) <= p[ZONE]) {
    const double integral = s->integral + p[KI] * (now->error + s->last_error);
    s->integral = fmin(fmax(integral, setup->lowest_torque), setup->highest_torque);
  }
  s->last_error = now->error;
  return s->integral + p[KP] * now->error;
}

static const zerocount_controller controller = {
    .size = sizeof(zerocount_controller),
    .abi_version = ZEROCOUNT_CONTROLLER_ABI,
    .name = "pi",
    .version = "1.0",
    .parameters = parameters,
    .parameter_count = sizeof(parameters) / sizeof(parameters[0]),
    .state_size = sizeof(state),
    .start = start,
    .step = step,
};

const zerocount_controller* zerocount_controller_entry(void) {
  return &controller;
}
