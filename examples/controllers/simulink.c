/* A plugin around the code that Simulink generates for the model my_controller (docs/your-own-controller.md).
 * my_controller.h and the generated ert_main.c show the names of types and arguments. */
#include <stdio.h>

#include "my_controller.h" /* generated */
#include <zerocount/controller.h>

typedef struct {
  RT_MODEL_my_controller_T model;
  DW_my_controller_T states;
} state;

/* The state may have moved since the last call: sets each pointer that the generated structure has. */
static RT_MODEL_my_controller_T* connected(state* s) {
  s->model.dwork = &s->states;
  return &s->model;
}

static int start(void* memory, const zerocount_setup* setup, char* message, size_t message_size) {
  const double fixed_step = 5.0e-4; /* s, of the model */
  if (setup->sample_time != fixed_step) {
    snprintf(message, message_size, "the model has a fixed step of %g s", fixed_step);
    return 1;
  }
  my_controller_initialize(connected(memory));
  return 0;
}

static double step(void* memory, const zerocount_setup* setup, const zerocount_sample* now) {
  double torque = 0.0;
  (void)setup;
  my_controller_step(connected(memory), now->error, &torque); /* with individual arguments */
  return torque;
}

static const zerocount_controller controller = {
    .size = sizeof(zerocount_controller),
    .abi_version = ZEROCOUNT_CONTROLLER_ABI,
    .name = "my_controller",
    .version = "1.0",
    .state_size = sizeof(state),
    .start = start,
    .step = step,
};

const zerocount_controller* zerocount_controller_entry(void) {
  return &controller;
}
