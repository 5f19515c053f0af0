#include "runners/verification/check.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace zerocount::verification {

bool holds(const CheckReport& report) {
  return std::all_of(report.checks.begin(), report.checks.end(),
                     [](const Check& check) { return check.problems.empty(); });
}

ProblemList::~ProblemList() {
  if (others_ > 0) check_.problems.push_back(fmt::format("and {} more", others_));
}

void ProblemList::add(std::string problem) {
  if (check_.problems.size() < max_problems) {
    check_.problems.push_back(std::move(problem));
  } else {
    ++others_;
  }
}

void require_no_stop(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Failure(ExitCode::interrupted, "interrupted: not everything was checked");
}

std::string problem_of(const Failure& failure, const std::filesystem::path& path) {
  const std::string_view message = failure.what();
  const std::string start = path.string() + ": ";
  return std::string(message.starts_with(start) ? message.substr(start.size()) : message);
}

}  // namespace zerocount::verification
