#include "runners/verification/replay.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"
#include "runners/study_run/recorded_trials.hpp"

namespace zerocount::verification {
namespace {

bool same(double a, double b, Equality equality, double allowed = 0.0) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  if (equality == Equality::bits) return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  return std::abs(a - b) <= std::max(allowed, 1e-9 * std::max(std::abs(a), std::abs(b)));
}

/// Absolute tolerance of a column. A position in counts is the difference of large numbers and has the
/// accuracy of θ. After a breakaway θ is accurate to 1e-3 count, which is more than this for encoders of up
/// to 60 million counts per revolution.
double allowed_in(const layout::Column& column) {
  if (column.unit == "rad") return 1e-10;
  return column.unit == "count" ? 1e-3 : 0.0;
}

/// How records are compared: `what` names one in messages.
struct Comparison {
  std::string_view what;
  Equality equality;
};

/// Compares two lists of records field by field.
template <class Record>
void compare(const std::vector<layout::RecordField<Record>>& fields, const std::vector<Record>& recorded,
             const std::vector<Record>& replayed, const Comparison& comparison,
             std::vector<std::string>& lines) {
  const std::string_view what = comparison.what;
  if (recorded.size() != replayed.size()) {
    lines.push_back(fmt::format("{}s: recorded {}, replayed {}", what, recorded.size(), replayed.size()));
    return;
  }
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    for (const layout::RecordField<Record>& field : fields) {
      const double before = layout::value_of(field, recorded[i]);
      const double now = layout::value_of(field, replayed[i]);
      const bool real = field.column.element == hdf5::Element::float64;
      if (real ? same(before, now, comparison.equality, allowed_in(field.column)) : before == now) continue;
      lines.push_back(
          fmt::format("{} {}: {}: recorded {}, replayed {}", what, i, field.column.name, before, now));
    }
  }
}

/// The moves with their outcomes as a file of this layout version stores them.
std::vector<trial::MoveOutcome> moves_in_version(std::int64_t version,
                                                 std::vector<trial::MoveOutcome> moves) {
  for (trial::MoveOutcome& move : moves) move.outcome = layout::outcome_in_version(version, move.outcome);
  return moves;
}

std::vector<layout::JerkRecord> jerk_records(const shards::TrialResult& result) {
  std::vector<layout::JerkRecord> records;
  for (const trial::Jerk& jerk : result.jerks) records.push_back({jerk, result.row});
  return records;
}

std::vector<layout::TraceRecord> trace_records(const shards::TrialResult& result) {
  std::vector<layout::TraceRecord> records;
  for (const trial::SampleRecord& record : result.trace) records.push_back({record, result.row});
  return records;
}

}  // namespace

Equality equality_of(const layout::FileHeader& header) {
  const layout::Provenance here = layout::current_provenance();
  const layout::Provenance& there = header.provenance;
  const bool same =
      layout::same_build(there, here) && there.compiler == here.compiler && there.cpu == here.cpu;
  return same ? Equality::bits : Equality::rounded;
}

std::vector<std::string> differences(const std::vector<study::InputColumn>& inputs,
                                     const shards::TrialResult& recorded, const shards::TrialResult& replayed,
                                     const std::vector<layout::RecordField<trial::MoveOutcome>>& measures,
                                     std::int64_t version, Equality equality) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (same(recorded.inputs.at(i), replayed.inputs.at(i), equality)) continue;
    lines.push_back(fmt::format("input {}: recorded {}, replayed {}", inputs[i].name, recorded.inputs[i],
                                replayed.inputs[i]));
  }
  compare(measures, recorded.outcome.moves, moves_in_version(version, replayed.outcome.moves),
          {"move", equality}, lines);
  compare(layout::jerk_fields(), jerk_records(recorded), jerk_records(replayed), {"jerk", equality}, lines);
  return lines;
}

std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult* recorded,
                                                 const shards::TrialResult& replayed, Equality equality) {
  const bool kept = !layout::has_sums(file.header().retention) || !trial::succeeded(replayed.outcome.moves);
  if (kept != (recorded != nullptr)) {
    return {fmt::format("recorded as a {}, replayed as a {}", kept ? "success" : "failure",
                        kept ? "failure" : "success")};
  }
  if (!recorded) return {};
  const reading::TrialTables& trials = *file.trials();
  std::vector<std::string> lines = differences(trials.input_columns(), *recorded, replayed, trials.measures(),
                                               file.header().version, equality);
  if (!recorded->trace.empty()) {
    compare(layout::trace_fields(trials.features()), trace_records(*recorded), trace_records(replayed),
            {"record", equality}, lines);
  }
  return lines;
}

std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality) {
  if (!file.trials()) return {};
  const std::vector<shards::TrialResult> recorded =
      study_run::read_trials(*file.trials(), {replayed.row, 1}, replayed.row, {});
  return differences_from_record(file, recorded.empty() ? nullptr : &recorded.front(), replayed, equality);
}

}  // namespace zerocount::verification
