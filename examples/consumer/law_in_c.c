/* A control law in C, tried on a trial of a study by the C interface of zerocount: the integral of the error. */
#include <stdio.h>
#include <string.h>
#include <zerocount/zerocount.h>

static const char manifest[] =
    "{zerocount: 1, name: example, seed: 1, trials: 1, command: {targets: [5], hold: 1.0}}";

typedef struct {
  zerocount_law law;
  double sum; /* of the errors, counts */
} integral;

static double step(void* context) {
  integral* its = context;
  its->sum += its->law.sample.error;
  return 8e-5 * its->sum; /* N m */
}

static int failed(void) {
  fprintf(stderr, "%s\n", zerocount_message());
  return 1;
}

int main(void) {
  zerocount_study* study = NULL;
  zerocount_job* job = NULL;
  integral control = {.law = {.size = sizeof(zerocount_law), .step = step, .context = &control}};
  if (zerocount_abi_version() != ZEROCOUNT_ABI) return 1;
  if (zerocount_read_study(manifest, strlen(manifest), "example", ".", NULL, 0, &study) != 0) return failed();
  if (zerocount_start_trial(study, 0, 0, &control.law, &job) != 0) return failed();

  size_t count = 0;
  const zerocount_array* arrays = zerocount_result(job, &count);
  for (size_t i = 0; i < count; ++i) {
    if (strcmp(arrays[i].name, "samples/error") == 0) {
      const int64_t* errors = arrays[i].values; /* its type is int64 */
      printf("%lld counts of error at the end\n", (long long)errors[arrays[i].size - 1]);
    }
  }
  zerocount_free_job(job);
  zerocount_free_study(study);
  return 0;
}
