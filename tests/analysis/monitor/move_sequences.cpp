#include "tests/analysis/monitor/move_sequences.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/designs/random_key.hpp"

namespace zerocount::testing {
namespace {

constexpr std::uint64_t seed = 20261127;

monitor::ChangeTest test_after_baseline(const Sequence& sequence, random::NumberSource& numbers) {
  std::vector<double> baseline;
  for (std::int64_t i = 0; i < sequence.baseline; ++i) baseline.push_back(move_value(sequence.kind, numbers));
  return monitor::ChangeTest(std::move(baseline), designs::random_key(seed, "ties"));
}

std::string experiment_of(const Sequence& sequence) {
  return fmt::format("{}.{}.{}", name_of(sequence.kind), sequence.baseline, sequence.factor);
}

}  // namespace

std::string_view name_of(Moves kind) {
  switch (kind) {
    case Moves::lognormal:
      return "continuous";
    case Moves::tied:
      return "tied";
    case Moves::binary:
      break;
  }
  return "binary";
}

double move_value(Moves kind, random::NumberSource& numbers, double factor) {
  if (kind == Moves::binary) return numbers.uniform() < 0.95 * factor ? 1.0 : 0.0;
  const double value = 0.05 * std::exp(0.25 * numbers.normal()) * factor;
  return kind == Moves::tied ? 0.02 * std::rint(value / 0.02) : value;
}

random::NumberSource numbers_of(std::string_view experiment, std::uint32_t number) {
  return random::NumberSource(designs::random_key(seed, experiment), number);
}

double largest_capital(const Sequence& sequence, std::uint32_t number) {
  random::NumberSource numbers = numbers_of(experiment_of(sequence), number);
  monitor::ChangeTest test = test_after_baseline(sequence, numbers);
  double largest = 0.0;
  for (std::int64_t t = 0; t < sequence.moves; ++t) {
    test.update(move_value(sequence.kind, numbers));
    largest = std::max(largest, test.martingale().capital());
  }
  return largest;
}

std::optional<std::int64_t> delay_of(const Sequence& sequence, double alarm, std::uint32_t number) {
  random::NumberSource numbers = numbers_of(experiment_of(sequence), number);
  monitor::ChangeTest test = test_after_baseline(sequence, numbers);
  for (std::int64_t t = 1; t <= sequence.moves; ++t) {
    test.update(move_value(sequence.kind, numbers, t >= sequence.change ? sequence.factor : 1.0));
    if (test.martingale().capital() >= alarm) return t - sequence.change + 1;
  }
  return std::nullopt;
}

std::string log_text(std::string_view head, const std::vector<double>& values) {
  std::string text = fmt::format("{}\n", head);
  for (const double value : values) text += fmt::format("{}\n", value);
  return text;
}

monitor::MoveLog log_of(std::string_view text, std::string name) {
  monitor::MoveLog log(std::move(name));
  log.read_last(text.substr(log.read(text)));
  return log;
}

}  // namespace zerocount::testing
