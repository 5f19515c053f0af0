#ifndef ZEROCOUNT_CONTROLLER_H
#define ZEROCOUNT_CONTROLLER_H

/* A controller of one's own for zerocount, as a shared library.
 *
 * The library has one function, zerocount_controller_entry(), which returns the description of the
 * controller: its parameters, the size of its state, and the functions that run it. Write
 *
 *   ZEROCOUNT_EXPORT const zerocount_controller* zerocount_controller_entry(void) { return &controller; }
 *
 * in C or C++ (in C++ the declaration below makes it extern "C").
 *
 * The rules:
 * - All that changes from sample to sample is in the state, which zerocount allocates, and which may be
 * copied to another address between two samples. So no pointers into itself, no global or static variables
 * that change. zerocount runs trials in parallel, and checks this by running some of them twice in another
 * order.
 * - `step` allocates no memory, does no input and output, and does not throw.
 * - The same inputs give the same bits. Compile without -ffast-math and with -ffp-contract=off. The last bit
 * of exp, sin … of the C library may depend on the processor; for the same bits on all of them call functions
 * that do not, such as those of SLEEF that are compiled without fused operations.
 *
 * On a linear axis read m for rad, and N for N m. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ZEROCOUNT_CONTROLLER_ABI 2

#if defined(_WIN32)
#define ZEROCOUNT_EXPORT __declspec(dllexport)
#else
#define ZEROCOUNT_EXPORT __attribute__((visibility("default")))
#endif

/* A parameter: controller.parameters.NAME in manifests. */
typedef struct zerocount_parameter {
  const char* name;    /* lower-case letters, digits and _, a letter first */
  const char* unit;    /* "1" if dimensionless */
  const char* meaning; /* one line */
  double default_value;
  double lowest;  /* allowed value; -INFINITY: no limit */
  double highest; /* allowed value; INFINITY: no limit */
} zerocount_parameter;

/* What is the same at all samples of a trial. */
typedef struct zerocount_setup {
  uint32_t size;            /* of this struct, bytes */
  uint32_t parameter_count; /* of the controller */
  const double* parameters; /* their values in this trial, in the order of the controller */
  double sample_time;       /* T, s */
  double resolution;        /* of the encoder, rad per count */
  double torque_resolution; /* of the converter, N m per code */
  double lowest_torque;     /* that the converter can give, N m */
  double highest_torque;    /* that the converter can give, N m */
  double
      initial_integral; /* I before the first sample: initial.integral, and what initial.holding adds, N m */
  double other_resolution; /* of the encoder of the other mass, rad per count; 0: there is none */
} zerocount_setup;

/* A sampling instant. */
typedef struct zerocount_sample {
  int64_t k;        /* number of the sample in the trial, from 0 */
  double time;      /* k T, s */
  double error;     /* reference, rounded to counts, less count */
  double count;     /* of the encoder that closes the loop, counts of the fine one */
  double reference; /* before it is rounded, counts */
  double torque; /* decided at the sample before, in whole DAC steps within the range, N m; 0 at the first */
  double velocity;     /* of the reference before it is rounded, rad/s */
  double acceleration; /* of the reference before it is rounded, rad/s^2 */
  int32_t new_target;  /* 1 at the first sample with another target, otherwise 0 */
  double other_count;  /* of the encoder of the other mass, counts of it; 0 where there is none */
} zerocount_sample;

/* The controller. */
typedef struct zerocount_controller {
  uint32_t size;        /* of this struct, bytes: sizeof(zerocount_controller) */
  uint32_t abi_version; /* ZEROCOUNT_CONTROLLER_ABI */
  const char* name;     /* not empty */
  const char* version;  /* not empty; stands in results files */
  const zerocount_parameter* parameters;
  uint32_t parameter_count;
  uint32_t state_size; /* bytes; the state is aligned to 64 bytes */

  /* Prepares the state, whose bytes are 0, for the first sample of a trial. Returns 0. If the parameters make
   * no sense together, writes why into `message`, of `message_size` bytes, and returns any other number: the
   * run ends with this message. */
  int (*start)(void* state, const zerocount_setup* setup, char* message, size_t message_size);

  /* The wanted torque (N m) at this sample; the converter rounds and limits it. NaN: the controller cannot go
   * on. Then, and if it is infinite, the trial ends there as `nonfinite`. */
  double (*step)(void* state, const zerocount_setup* setup, const zerocount_sample* sample);
} zerocount_controller;

/* The one function of the library. What it returns stays valid. */
ZEROCOUNT_EXPORT const zerocount_controller* zerocount_controller_entry(void);

#ifdef __cplusplus
}
#endif

#endif
