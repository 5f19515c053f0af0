#include "runners/child_process/child_process.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/failure/failure.hpp"

extern char** environ;

namespace zerocount::child_process {
namespace {

[[noreturn]] void fail(const std::string& program, int error) {
  throw Failure(ExitCode::machine_failed,
                fmt::format("{}: cannot be run: {}", program, std::strerror(error)));
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using NamelessFile = std::unique_ptr<std::FILE, CloseFile>;

/// Makes a temporary file that has no name and disappears when it is closed. Unlike a pipe it holds any
/// amount of data without a concurrent reader.
/// @param program program to be run, for messages
NamelessFile nameless_file(const std::string& program) {
  NamelessFile file(std::tmpfile());
  if (!file) fail(program, errno);
  return file;
}

std::string content_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char block[65536];
  for (std::size_t size = std::fread(block, 1, sizeof block, file); size > 0;
       size = std::fread(block, 1, sizeof block, file)) {
    text.append(block, size);
  }
  return text;
}

/// Redirects standard input, output and error of a child process to open files.
class Redirections {
 public:
  Redirections(std::FILE* in, std::FILE* out, std::FILE* err) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, fileno(in), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, fileno(out), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, fileno(err), STDERR_FILENO);
  }
  Redirections(const Redirections&) = delete;
  Redirections& operator=(const Redirections&) = delete;
  ~Redirections() { posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

std::optional<ChildResult> run_child(const std::vector<std::string>& words, std::string_view input) {
  const std::string& program = words.front();
  const NamelessFile in = nameless_file(program);
  const NamelessFile out = nameless_file(program);
  const NamelessFile err = nameless_file(program);
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
    fail(program, errno);
  std::rewind(in.get());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Redirections redirections(in.get(), out.get(), err.get());
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, program.c_str(), redirections.get(), nullptr, arguments.data(), environ);
  if (error == ENOENT) return std::nullopt;
  if (error != 0) fail(program, error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail(program, errno);
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ChildResult{code, content_of(out.get()), content_of(err.get())};
}

}  // namespace zerocount::child_process
