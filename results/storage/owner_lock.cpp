#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"

namespace zerocount::storage {
namespace {

namespace fs = std::filesystem;

struct Owner {
  std::string host;
  std::string machine;
  std::int64_t process{0};
};

std::string this_host() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

std::string prefix_of(const fs::path& output) {
  return output.filename().string() + ".owner-";
}

fs::path own_file(fs::path output) {
  std::random_device random;
  const std::string name = fmt::format("{}{}-{}-{}-{:08x}", prefix_of(output), this_host(), this_machine(),
                                       ::getpid(), std::uint32_t{random()});
  return output.replace_filename(name);
}

/// Removes "-TEXT", the last part of an owner file's name, from the end of `text`.
/// @returns TEXT; empty if there is no "-".
std::optional<std::string_view> take_last(std::string_view& text) {
  const std::size_t dash = text.rfind('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const std::string_view last = text.substr(dash + 1);
  text = text.substr(0, dash);
  return last;
}

/// The owner of an output that the name of an owner file describes; empty for the name of any other file.
std::optional<Owner> owner_of(const fs::path& file, const std::string& prefix) {
  const std::string name = file.filename().string();
  if (!name.starts_with(prefix)) return std::nullopt;
  std::string_view rest = std::string_view(name).substr(prefix.size());
  const auto random = take_last(rest), process = take_last(rest), machine = take_last(rest);
  if (!random || !process || !machine || rest.empty()) return std::nullopt;
  Owner owner{std::string(rest), std::string(*machine)};
  const auto [end, error] =
      std::from_chars(process->data(), process->data() + process->size(), owner.process);
  if (error != std::errc{} || end != process->data() + process->size()) return std::nullopt;
  return owner;
}

std::vector<fs::path> owner_files(const fs::path& output) {
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (owner_of(entry->path(), prefix_of(output))) files.push_back(entry->path());
  if (error) fail_with(folder, "look for other runs in", error.value());
  return files;
}

/// Whether the system knows that the owner's process has ended. False for a process of another computer.
bool has_ended(const Owner& owner) {
  return owner.machine == this_machine() && ::kill(static_cast<pid_t>(owner.process), 0) != 0 &&
         errno == ESRCH;
}

/// Time of modification of a file, ns since 1970; empty if there is no such file. The file is opened first,
/// because that makes a network file system ask the server.
std::optional<std::int64_t> time_of(const fs::path& file) {
  const FileDescriptor opened(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!opened.valid() || ::fstat(opened.get(), &status) != 0) return std::nullopt;
  constexpr std::int64_t second = 1'000'000'000;
  return status.st_mtim.tv_sec * second + status.st_mtim.tv_nsec;
}

/// Waits until it is known whether the owner of the lock file `file` lives: it has renewed the file, or has
/// not done so within the patience.
/// @returns whether it lives.
bool shows_itself(const fs::path& file, const Heartbeat& heartbeat) {
  const std::optional<std::int64_t> before = time_of(file);
  const auto deadline = std::chrono::steady_clock::now() + heartbeat.patience;
  for (std::optional<std::int64_t> now = before; now; now = time_of(file)) {
    if (now != before) return true;
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(heartbeat.interval / 4);
  }
  return false;
}

[[noreturn]] void end_because_taken(const fs::path& file) {
  fmt::print(stderr,
             "{}: another run has taken this output, because this one was halted; what is finished is kept\n",
             file.string());
  std::fflush(stderr);
  ::_exit(static_cast<int>(ExitCode::machine_failed));
}

void renew(const std::stop_token& stop, const fs::path& file, std::chrono::milliseconds interval) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    if (::utimensat(AT_FDCWD, file.c_str(), nullptr, AT_SYMLINK_NOFOLLOW) != 0 && errno == ENOENT)
      end_because_taken(file);
    wake.wait_for(lock, stop, interval, [] { return false; });
  }
}

}  // namespace

std::string this_machine() {
  constexpr std::size_t length = 12;
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  std::error_code ignored;
  const fs::path names = fs::read_symlink("/proc/self/ns/pid", ignored);
  return hash::sha256_hex(boot + names.string()).substr(0, length);
}

OwnerLock::OwnFile::OwnFile(fs::path file) : path(std::move(file)) {
  const FileDescriptor made(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!made.valid()) fail_with(path, "make the lock file", errno);
}

OwnerLock::OwnFile::~OwnFile() {
  ::unlink(path.c_str());
}

OwnerLock::OwnerLock(const fs::path& output, Heartbeat heartbeat)
    : file_(own_file(output)), heart_([file = file_.path, heartbeat](const std::stop_token& stop) {
        renew(stop, file, heartbeat.interval);
      }) {
  for (const fs::path& file : owner_files(output)) {
    const Owner owner = owner_of(file, prefix_of(output)).value();
    if (file.filename() == file_.path.filename()) continue;
    if (has_ended(owner) || !shows_itself(file, heartbeat)) {
      ::unlink(file.c_str());
      continue;
    }
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: another run is writing this output: process {} on {}; wait for it or stop "
                              "it, or name another output",
                              output.string(), owner.process, owner.host));
  }
}

bool is_owned(const fs::path& output) {
  const std::vector<fs::path> files = owner_files(output);
  return std::any_of(files.begin(), files.end(), [](const fs::path& file) {
    const std::optional<std::int64_t> time = time_of(file);
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return time && now - std::chrono::nanoseconds(*time) < 2 * Heartbeat{}.patience;
  });
}

}  // namespace zerocount::storage
