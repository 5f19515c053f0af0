// Preloaded into a program (LD_PRELOAD), it stands for a file system that has no fsync for folders: there the
// call fails with the errno of the environment's FSYNC_ERROR.
#include <cerrno>
#include <cstdlib>

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" int fsync(int file) {
  struct stat status {};
  const char* const error = std::getenv("FSYNC_ERROR");
  if (error != nullptr && ::fstat(file, &status) == 0 && S_ISDIR(status.st_mode)) {
    errno = std::atoi(error);
    return -1;
  }
  return static_cast<int>(syscall(SYS_fsync, file));
}
