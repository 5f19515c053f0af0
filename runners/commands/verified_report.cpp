#include "runners/commands/verified_report.hpp"

#include <string>
#include <vector>

#include "runners/status/status.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::commands {

report::StudyReport verified_report(const reading::AllTrialsFile& file, report::ReportOptions options) {
  options.check = [&](const report::ReplayedTrial& replayed) {
    auto [different, parting] = verification::compare_with_record(file, file.study(), replayed.result);
    if (parting)
      different.push_back(
          verification::text_of(*parting) +
          ", because the loop amplifies the rounding that parts the two engines, and the figure "
          "is of the reference engine");
    return different;
  };
  report::StudyReport report = report::study_report(file, options);
  for (const std::string& warning : report.warnings) status::tell("zerocount: warning: {}\n", warning);
  return report;
}

}  // namespace zerocount::commands
