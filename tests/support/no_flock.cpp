// Preloaded into a program (LD_PRELOAD), it stands for a file system without flock.
#include <cerrno>

#include <sys/file.h>

extern "C" int flock(int, int) noexcept {
  errno = EOPNOTSUPP;
  return -1;
}
