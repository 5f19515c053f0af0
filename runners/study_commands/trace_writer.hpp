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

/// The trial whose trace is written: its study, design point, number and parameters.
struct TraceSubject {
  const study::Study& study;
  std::int64_t point{0};
  std::int64_t index{0};
  const study::StudyTrial& trial;
};

/// Writes the trace of one trial (all its samples), record by record. The columns are the columns of /trace
/// in the results file without `trial`, in the same order. The optional columns (Study::features) come last.
/// Numbers read back to the same double. In JSON, non-finite values are null.
class TraceWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// @param sink function that receives the text in pieces
  /// @param json true: a JSON object with the trial's inputs, samples and outcome; false: CSV, one line per
  /// sample
  TraceWriter(Sink sink, bool json) : sink_(std::move(sink)), json_(json) {}

  void begin(const TraceSubject& subject);
  void write(const trial::SampleRecord& record);
  void end(const trial::TrialOutcome& outcome);

 private:
  Sink sink_;
  bool json_;
  std::vector<layout::RecordField<layout::TraceRecord>> columns_;  ///< Columns of the trace; set by begin().
  /// Measures of a move that JSON has at its end; set by begin().
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  bool first_{true};
};

}  // namespace zerocount::study_commands
