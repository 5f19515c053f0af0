#pragma once

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::study_commands {

/// The trial of a trace.
struct TraceSubject {
  const study::Study& study;
  std::int64_t point{0};
  std::int64_t index{0};
  const study::StudyTrial& trial;
};

/// Writes the trace of one trial, record by record. The columns are those of the results file's /trace
/// without `trial`, in the same order; the optional columns (Study::features) come last. Numbers read
/// back to the same double; in JSON non-finite values are null.
class TraceWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// @param sink receives the text in pieces
  /// @param json true: a JSON object with the trial's inputs, samples and outcome; false: CSV, one line per
  /// sample
  TraceWriter(Sink sink, bool json) : sink_(std::move(sink)), json_(json) {}

  void begin(const TraceSubject& subject);
  void write(const trial::SampleRecord& record);
  void end(const trial::TrialOutcome& outcome);

 private:
  Sink sink_;
  bool json_;
  std::vector<layout::RecordField<layout::TraceRecord>> columns_;  ///< set by begin()
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;  ///< set by begin()
  bool first_{true};
};

}  // namespace zerocount::study_commands
