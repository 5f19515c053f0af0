/* A PI controller with one fault, by its number FAULT. */

#include <math.h>
#include <string.h>
#include <xmmintrin.h>

#include <zerocount/controller.h>

enum {
  NONE,
  OTHER_ABI,
  OTHER_SIZE,
  NO_NAME,
  NO_STEP,
  BAD_PARAMETER_NAME,
  SAME_NAMES,
  BAD_RANGE,
  BAD_DEFAULT,
  LARGE_STATE,
  NO_ENTRY,
  NOTHING,
  GLOBAL_STATE,
  GLOBAL_STATE_FROM_START,
  POINTER_INTO_STATE,
  NOT_A_NUMBER,
  REFUSES_START,
  OTHER_ARITHMETIC,
  CRASHES
};

typedef struct {
  double integral;
  double last_error;
  double* place; /* of the integral */
} state;

static double outside; /* I, for the faults that keep it outside the state */

/* Rounds towards zero, and takes denormal numbers for 0, as libraries that are compiled with -ffast-math do. */
static void change_arithmetic(void) {
  _mm_setcsr(_mm_getcsr() | 0xe040);
}

__attribute__((constructor)) static void loaded(void) {
  if (FAULT == OTHER_ARITHMETIC) change_arithmetic();
}

static int start(void* memory, const zerocount_setup* setup, char* message, size_t message_size) {
  state* s = memory;
  if (FAULT == REFUSES_START) {
    strncpy(message, "gain and zone do not fit", message_size);
    return 1;
  }
  if (FAULT == GLOBAL_STATE_FROM_START) outside = setup->initial_integral;
  s->integral = setup->initial_integral;
  s->place = &s->integral;
  return 0;
}

static double step(void* memory, const zerocount_setup* setup, const zerocount_sample* now) {
  state* s = memory;
  double* integral = &s->integral;
  if (FAULT == GLOBAL_STATE || FAULT == GLOBAL_STATE_FROM_START) integral = &outside;
  if (FAULT == POINTER_INTO_STATE) integral = s->place;
  if (FAULT == CRASHES && now->k >= 100) *(volatile double*)8 = 0.0;
  if (FAULT == NOT_A_NUMBER && now->k >= 100) return NAN;
  *integral += setup->parameters[0] * (now->error + s->last_error);
  *integral = fmin(fmax(*integral, setup->lowest_torque), setup->highest_torque);
  s->last_error = now->error;
  const double torque = *integral;
  if (FAULT == OTHER_ARITHMETIC) change_arithmetic();
  return torque;
}

static const zerocount_parameter parameters[] = {
    {FAULT == BAD_PARAMETER_NAME ? "Gain 1" : "ki", "N m/count", "integral gain",
     FAULT == BAD_DEFAULT ? -1.0 : 9.45e-5, FAULT == BAD_RANGE ? 2.0 : 0.0, 1.0},
    {FAULT == SAME_NAMES ? "ki" : "unused", "1", "nothing", 0.0, -INFINITY, INFINITY},
};

static const zerocount_controller controller = {
    .size = FAULT == OTHER_SIZE ? 16 : sizeof(zerocount_controller),
    .abi_version = FAULT == OTHER_ABI ? 99 : ZEROCOUNT_CONTROLLER_ABI,
    .name = FAULT == NO_NAME ? "" : "faulty",
    .version = "0",
    .parameters = parameters,
    .parameter_count = 2,
    .state_size = FAULT == LARGE_STATE ? 1u << 30 : sizeof(state),
    .start = start,
    .step = FAULT == NO_STEP ? NULL : step,
};

#if FAULT == 10
int zerocount_no_controller(void) {
  return controller.size != 0;
}
#else
const zerocount_controller* zerocount_controller_entry(void) {
  return FAULT == NOTHING ? NULL : &controller;
}
#endif
