#include "results/hdf5/foreign_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::hdf5 {
namespace {

constexpr rlim_t max_cpu_time = 20;  // s
constexpr unsigned max_time = 120;   // s, of the disk too

/// Largest size of an attribute, or of the references to a dataset's texts, that the child process reads,
/// bytes
constexpr std::size_t max_bytes = 256U << 20U;

/// Signals that mean that the child process has crashed. SIGXCPU: it has exceeded its processor time.
constexpr std::array crashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU};

/// Allocates a buffer for elements of the type as they stand in the file; empty if it would be larger than
/// the child process should read. Texts need not be freed in a process that ends.
std::vector<std::byte> room_for(Id type, hssize_t elements) {
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || elements <= 0 || static_cast<std::size_t>(elements) > max_bytes / size) return {};
  return std::vector<std::byte>(size * static_cast<std::size_t>(elements));
}

herr_t read_attribute(Id object, const char* name, const H5A_info_t*, void*) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  std::vector<std::byte> values = room_for(type.get(), H5Sget_simple_extent_npoints(space.get()));
  if (!values.empty()) H5Aread(attribute.get(), type.get(), values.data());
  return 0;
}

/// Reads, to provoke a crash, all texts of a dataset, or its first element if it holds numbers.
void read_dataset(Id dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (H5Tget_class(type.get()) != H5T_STRING && rank > 0 && H5Sget_simple_extent_npoints(space.get()) > 0) {
    const std::vector<Size> first(static_cast<std::size_t>(rank), 0);
    H5Sselect_elements(space.get(), H5S_SELECT_SET, 1, first.data());
  }
  const hssize_t elements = H5Sget_select_npoints(space.get());
  std::vector<std::byte> values = room_for(type.get(), elements);
  if (values.empty()) return;
  const auto count = static_cast<Size>(elements);
  const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
  H5Dread(dataset, type.get(), memory.get(), space.get(), H5P_DEFAULT, values.data());
}

herr_t read_object(Id file, const char* name, const H5O_info_t* info, void*) {
  const Handle object(H5Oopen(file, name, H5P_DEFAULT), H5Oclose);
  H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, read_attribute, nullptr);
  if (info->type == H5O_TYPE_DATASET) read_dataset(object.get());
  return 0;
}

class UntrustedFile : public File {
 public:
  explicit UntrustedFile(const std::filesystem::path& path) : File(File::open_to_read(path)) {}

  void read_all_objects() const {
    H5Ovisit2(id(), H5_INDEX_NAME, H5_ITER_INC, read_object, nullptr, H5O_INFO_BASIC);
  }
};

/// Reads the file in the child process and ends the process. Only a crash matters, because the parent process
/// finds other errors again and reports them.
[[noreturn]] void read_and_exit(const std::filesystem::path& path, pid_t parent) {
  // The child has the parent's locks: it must not outlive it, or the same command could not go on.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(EXIT_SUCCESS);
  for (const int signal : crashes) std::signal(signal, SIG_DFL);
  std::signal(SIGALRM, SIG_DFL);
  alarm(max_time);
  std::freopen("/dev/null", "w", stderr);
  const rlimit no_core{0, 0};
  const rlimit time{max_cpu_time, max_cpu_time + 1};  // SIGXCPU before SIGKILL
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  try {
    UntrustedFile(path).read_all_objects();
  } catch (...) {
    _exit(EXIT_SUCCESS);
  }
  _exit(EXIT_SUCCESS);
}

/// Whether a child process can be made by fork(). The allocators of clang 14's sanitizers are not prepared
/// for fork: the child would wait for ever if another thread was in one of them.
bool can_fork() {
#ifdef ZEROCOUNT_SANITIZED
  const std::filesystem::directory_iterator threads("/proc/self/task");
  return std::distance(begin(threads), end(threads)) == 1;
#else
  return true;
#endif
}

void read_in_child(const std::filesystem::path& path) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) storage::fail_with(path, "start a child process that reads it first", errno);
  if (child == 0) read_and_exit(path, parent);
  int status = 0;
  pid_t ended = -1;
  do {
    ended = waitpid(child, &status, 0);
  } while (ended < 0 && errno == EINTR);
  if (ended < 0) storage::fail_with(path, "wait for the child process that reads it first", errno);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == EXIT_SUCCESS || code == static_cast<int>(ExitCode::machine_failed)) return;
  if (WIFSIGNALED(status) && std::ranges::find(crashes, WTERMSIG(status)) == crashes.end()) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: the child process that reads it first was ended by signal {}{}",
                              path.string(), WTERMSIG(status),
                              WTERMSIG(status) == SIGALRM ? fmt::format(", after {} s", max_time)
                                                          : "; is the memory full?"));
  }
  throw Failure(ExitCode::bad_data,
                path.string() +
                    ": damaged: the HDF5 library fails when it reads it; a file that zerocount wrote "
                    "and nobody changed can be read");
}

}  // namespace

File open_foreign(const std::filesystem::path& path) {
  if (can_fork()) read_in_child(path);
  return File::open_to_read(path);
}

}  // namespace zerocount::hdf5
