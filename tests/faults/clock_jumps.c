/* Preloaded into a program (LD_PRELOAD), it makes every clock jump, as a suspended machine or a wrong time
 * server does.
 *
 *   CLOCK_AT    which reading of a clock is the first after the jump, from 1
 *   CLOCK_JUMP  size of the jump, s; negative: back
 */
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static atomic_long readings;

static long jump(void) {
  const char *at = getenv("CLOCK_AT");
  const char *size = getenv("CLOCK_JUMP");
  if (at == NULL || size == NULL || atomic_fetch_add(&readings, 1) + 1 < atol(at)) return 0;
  return atol(size);
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  const int result = (int)syscall(SYS_clock_gettime, clock, now);
  if (result == 0) now->tv_sec += jump();
  return result;
}

time_t time(time_t *place) {
  struct timespec now = {0, 0};
  clock_gettime(CLOCK_REALTIME, &now);
  if (place != NULL) *place = now.tv_sec;
  return now.tv_sec;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  struct timespec precise = {0, 0};
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return 0;
}
