#pragma once

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

namespace zerocount {

/// Which trial a trace is of.
struct TraceSubject {
  const Study& study;
  std::int64_t point{0};
  std::int64_t index{0};
  const StudyTrial& trial;
};

/// Writes the sample records of one trial, one by one: the columns of the results file's /trace but for the
/// trial, and in their order, those that only some studies have last (Study::trace_extras). Numbers read back
/// to the same double; in JSON what is not finite is null.
class TraceWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// @param sink takes the text, piece by piece
  /// @param json JSON: an object with the trial's inputs, its samples and its outcome; otherwise CSV: one
  /// line per sample.
  TraceWriter(Sink sink, bool json) : sink_(std::move(sink)), json_(json) {}

  void begin(const TraceSubject& subject);
  void write(const SampleRecord& record);
  void end(const TrialOutcome& outcome);

 private:
  Sink sink_;
  bool json_;
  std::vector<RecordField<TraceRecord>> columns_;   ///< since begin()
  std::vector<RecordField<MoveOutcome>> measures_;  ///< likewise
  bool first_{true};
};

}  // namespace zerocount
