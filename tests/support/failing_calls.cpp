// Preloaded into a program (LD_PRELOAD), this library makes one of the program's system calls fail, as a full
// or broken disk does. Variables of the environment say which call fails, and how:
//
//   FAIL_UNDER   folder: only calls on files in it are counted. Relative paths are taken to be in it.
//   FAIL_CALLS   "writes" (which include opening, truncating, synchronising, renaming and closing) or "reads"
//   FAIL_AT      number of the call that fails, counted from 1; 0: none
//   FAIL_ERROR   errno of the failure; "lost": a write reports success and writes nothing;
//                "signal9": no call fails, but the process gets this signal before the call
//   FAIL_LASTING "1": all later calls fail too
//   FAIL_COUNT   file to which the number of calls is written at the end
//
// It makes the system calls itself, so that it works beside the sanitizers' own replacements of these
// functions.
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

constexpr int lost = -1;

struct Plan {
  const char* folder{std::getenv("FAIL_UNDER")};
  const char* count_file{std::getenv("FAIL_COUNT")};
  bool reads{false};
  bool lasting{std::getenv("FAIL_LASTING") != nullptr};
  long at{0};
  int error{0};
  int signal{0};

  Plan() {
    const char* const which = std::getenv("FAIL_CALLS");
    const char* const where = std::getenv("FAIL_AT");
    const char* const how = std::getenv("FAIL_ERROR");
    reads = which != nullptr && std::strcmp(which, "reads") == 0;
    if (where != nullptr) at = std::atol(where);
    if (how != nullptr && std::strncmp(how, "signal", 6) == 0) {
      signal = std::atoi(how + 6);
      return;
    }
    if (how != nullptr) error = std::strcmp(how, "lost") == 0 ? lost : std::atoi(how);
  }
};

const Plan& plan() {
  static const Plan plan;
  return plan;
}

std::atomic<long> calls{0};

enum class Kind { read, write, other };

/// Counts a system call, if it is of the kind that the plan names, and sends the plan's signal if this is the
/// planned call. Returns the errno with which the call is to fail, `lost` for a write that is to be lost, or
/// 0 if the call is to be made.
int failure_of(Kind kind) {
  if ((kind == Kind::read) != plan().reads) return 0;
  const long number = ++calls;
  const bool hit = plan().at > 0 && (plan().lasting ? number >= plan().at : number == plan().at);
  if (hit && plan().signal > 0) syscall(SYS_kill, getpid(), plan().signal);
  if (!hit || (plan().error == lost && kind != Kind::write)) return 0;
  return plan().error;
}

bool is_watched(const char* path) {
  if (plan().folder == nullptr) return false;
  return path[0] != '/' || std::strncmp(path, plan().folder, std::strlen(plan().folder)) == 0;
}

bool is_watched(int file) {
  std::array<char, 64> link{};
  std::array<char, 4096> path{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", file);
  return syscall(SYS_readlink, link.data(), path.data(), path.size() - 1) > 0 && path[0] == '/' &&
         is_watched(path.data());
}

int failure_of(int file, Kind kind) {
  return is_watched(file) ? failure_of(kind) : 0;
}

template <class... Arguments>
long call(int error, long number, Arguments... arguments) {
  if (error > 0) {
    errno = error;
    return -1;
  }
  return syscall(number, arguments...);
}

ssize_t write_at(int file, const void* data, std::size_t size, off_t offset) {
  const int error = failure_of(file, Kind::write);
  return error == lost ? static_cast<ssize_t>(size) : call(error, SYS_pwrite64, file, data, size, offset);
}

ssize_t read_at(int file, void* data, std::size_t size, off_t offset) {
  return call(failure_of(file, Kind::read), SYS_pread64, file, data, size, offset);
}

int open_file(const char* path, int flags, mode_t mode) {
  const bool writes = (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0;
  const int error = writes && is_watched(path) ? failure_of(Kind::other) : 0;
  return static_cast<int>(call(error, SYS_openat, AT_FDCWD, path, flags, mode));
}

int truncate_file(int file, off_t size) {
  return static_cast<int>(call(failure_of(file, Kind::other), SYS_ftruncate, file, size));
}

__attribute__((destructor)) void write_count() {
  if (plan().count_file == nullptr) return;
  const long file = syscall(SYS_openat, AT_FDCWD, plan().count_file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::array<char, 32> text{};
  const int size = std::snprintf(text.data(), text.size(), "%ld", calls.load());
  syscall(SYS_write, file, text.data(), size);
  syscall(SYS_close, file);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* data, std::size_t size) {
  const int error = failure_of(file, Kind::write);
  return error == lost ? static_cast<ssize_t>(size) : call(error, SYS_write, file, data, size);
}

ssize_t pwrite(int file, const void* data, std::size_t size, off_t offset) {
  return write_at(file, data, size, offset);
}

ssize_t pwrite64(int file, const void* data, std::size_t size, off64_t offset) {
  return write_at(file, data, size, offset);
}

ssize_t read(int file, void* data, std::size_t size) {
  return call(failure_of(file, Kind::read), SYS_read, file, data, size);
}

ssize_t pread(int file, void* data, std::size_t size, off_t offset) {
  return read_at(file, data, size, offset);
}

ssize_t pread64(int file, void* data, std::size_t size, off64_t offset) {
  return read_at(file, data, size, offset);
}

int open(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const int result = open_file(path, flags, va_arg(more, mode_t));
  va_end(more);
  return result;
}

int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const int result = open_file(path, flags, va_arg(more, mode_t));
  va_end(more);
  return result;
}

int ftruncate(int file, off_t size) noexcept {
  return truncate_file(file, size);
}

int ftruncate64(int file, off64_t size) noexcept {
  return truncate_file(file, size);
}

int fsync(int file) {
  return static_cast<int>(call(failure_of(file, Kind::other), SYS_fsync, file));
}

int mkdir(const char* path, mode_t mode) noexcept {
  const int error = is_watched(path) ? failure_of(Kind::other) : 0;
  return static_cast<int>(call(error, SYS_mkdir, path, mode));
}

int rename(const char* from, const char* to) noexcept {
  const int error = is_watched(to) ? failure_of(Kind::other) : 0;
  return static_cast<int>(call(error, SYS_rename, from, to));
}

int close(int file) {
  const bool writes = (syscall(SYS_fcntl, file, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const int error = writes ? failure_of(file, Kind::other) : 0;
  const long result = syscall(SYS_close, file);  // a file is closed even where that fails
  if (error > 0) errno = error;
  return error > 0 ? -1 : static_cast<int>(result);
}
}
