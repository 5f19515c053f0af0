#ifndef ZEROCOUNT_ZEROCOUNT_H
#define ZEROCOUNT_ZEROCOUNT_H

/* zerocount in one's own process, from any language that calls C: a study, its random variables, and the
 * outcomes and samples of its trials, with the same bits as the program gives.
 *
 *   zerocount_study* study = NULL;
 *   zerocount_job* job = NULL;
 *   if (zerocount_read_study(text, strlen(text), "axis.yaml", ".", NULL, 0, &study) != 0 ||
 *       zerocount_start_trial(study, 0, 17, NULL, &job) != 0)
 *     return fputs(zerocount_message(), stderr);
 *
 * - A function that returns int32_t gives 0, or the exit code that the program would end with: 2 bad input, 3
 *   too little data, 4 bad data, 5 the machine failed, 130 stopped. zerocount_message() then tells why.
 * - Texts are UTF-8. A path is bytes, as the system has it.
 * - A study does not change, and all threads may use it. One thread at a time uses a job.
 * - What a function makes is freed by the function named beside it; NULL may be freed.
 *
 * Without a suffix in its name (libzerocount.so) the library may be of any version: compare
 * zerocount_abi_version() with ZEROCOUNT_ABI before anything else. */

#include <stddef.h>
#include <stdint.h>
#include <zerocount/controller.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ZEROCOUNT_ABI 1

typedef struct zerocount_study zerocount_study;
typedef struct zerocount_job zerocount_job;

/* The version of this interface that the library has. */
ZEROCOUNT_EXPORT uint32_t zerocount_abi_version(void);

/* The version of zerocount, such as "0.1.0". */
ZEROCOUNT_EXPORT const char* zerocount_version(void);

/* Why the last call of this thread that failed did so: a line for each problem, as the program writes it. It
 * is valid until the next call of this thread. */
ZEROCOUNT_EXPORT const char* zerocount_message(void);

/* Checks a manifest. `source` stands for its name in messages; files that it names are found from `folder`.
 * An override is "key=value", as after --set. Free: zerocount_free_study(). */
ZEROCOUNT_EXPORT int32_t zerocount_read_study(const char* text, size_t size, const char* source,
                                              const char* folder, const char* const* overrides,
                                              size_t override_count, zerocount_study** study);

/* The study of a results file, as its trials were run. Free: zerocount_free_study(). */
ZEROCOUNT_EXPORT int32_t zerocount_open_study(const char* file, zerocount_study** study);

/* The study under one of its conditions. Free: zerocount_free_study(). */
ZEROCOUNT_EXPORT int32_t zerocount_study_under(const zerocount_study* study, const char* name,
                                               zerocount_study** under);

ZEROCOUNT_EXPORT void zerocount_free_study(zerocount_study* study);

/* What is known of a study, as a JSON object: its name, labels, axes, inputs, goals, the columns of trials
 * and others. Free: zerocount_free_text(). */
ZEROCOUNT_EXPORT int32_t zerocount_describe_study(const zerocount_study* study, char** json);

/* The random variables of a design point, as a JSON object of lists: `names`, `kinds` (value, score or row),
 * `units`, `distributions` as in a manifest, and `correlations` [variable][variable] of their normal scores.
 * Free: zerocount_free_text(). */
ZEROCOUNT_EXPORT int32_t zerocount_describe_variables(const zerocount_study* study, int64_t point,
                                                      char** json);

/* A manifest with its overrides as JSON; it is read, and not checked. Free: zerocount_free_text(). */
ZEROCOUNT_EXPORT int32_t zerocount_describe_manifest(const char* text, size_t size, const char* source,
                                                     const char* const* overrides, size_t override_count,
                                                     char** json);

ZEROCOUNT_EXPORT void zerocount_free_text(char* text);

/* Turns values [trial][variable] from standard normal scores, to which the correlations were applied, to the
 * values of the variables. */
ZEROCOUNT_EXPORT int32_t zerocount_values_at_scores(const zerocount_study* study, int64_t point,
                                                    int64_t trials, double* values);

/* A control law in place of that of the manifest. Filters, feedforward and observer act on its torque. */
typedef struct zerocount_law {
  uint32_t size; /* of this struct, bytes: sizeof(zerocount_law) */
  /* The wanted torque (N m; N on a linear axis) at the sample. NaN: the law cannot go on, and is not called
   * again. */
  double (*step)(void* context);
  void* context;
  zerocount_setup setup;   /* of the trial; written before the first call of `step`, without parameters */
  zerocount_sample sample; /* written before each call of `step` */
} zerocount_law;

/* Starts to simulate trials with these values [trial][variable] on so many threads. All random numbers beside
 * the variables follow from `numbers` [trial], each below 2^32. Both arrays must last until the job is done.
 * Free: zerocount_free_job().
 * The result: the measures of moves, [trial][move] each. */
ZEROCOUNT_EXPORT int32_t zerocount_start_outcomes(const zerocount_study* study, int64_t point, int64_t trials,
                                                  const double* values, const int64_t* numbers,
                                                  int32_t threads, zerocount_job** job);

/* Starts to simulate a trial. With a law the trial is over when this returns: the law runs in this thread.
 * Free: zerocount_free_job().
 * The result: "inputs" [input]; "samples/…" [sample]; "jerks/…" [jerk]; "outcome/…" [move]. */
ZEROCOUNT_EXPORT int32_t zerocount_start_trial(const zerocount_study* study, int64_t point, int64_t trial,
                                               zerocount_law* law, zerocount_job** job);

/* Waits until the job is done, or this time is over. A job that failed gives its code here. */
ZEROCOUNT_EXPORT int32_t zerocount_wait(zerocount_job* job, int32_t milliseconds, int32_t* done);

/* One array of a result. */
typedef struct zerocount_array {
  const char* name;
  const char* type; /* float64, int64, int32, int8 or bool (a byte) */
  int64_t size;     /* elements */
  const void* values;
} zerocount_array;

/* The result of a job that is done, valid until that is freed. */
ZEROCOUNT_EXPORT const zerocount_array* zerocount_result(const zerocount_job* job, size_t* count);

/* Stops the job if it is not done, and frees it. */
ZEROCOUNT_EXPORT void zerocount_free_job(zerocount_job* job);

#ifdef __cplusplus
}
#endif

#endif
