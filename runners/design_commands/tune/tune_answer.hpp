#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/document/description.hpp"
#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/tuner.hpp"

/// Parts of the answer of `tune`. Each part is added to the items of the whole answer.
namespace zerocount::design_commands {

using tuning::Tuning;

/// Answer with the verdict, the proof and the behaviour of the moves. It is printed before the extras are
/// made.
document::AnswerDescription<Tuning> proven_answer();

/// Answer with one extra.
document::AnswerDescription<Tuning> extra_answer(const tuning::Extra& extra);

/// Answer with the spent effort and the parts that were left out.
document::AnswerDescription<Tuning> closing_answer();

/// Complete answer with figures.
document::AnswerDescription<Tuning> tune_answer();

/// Answer with the margins of the tuned loops as a table, for the first screen of a page.
document::AnswerDescription<Tuning> margins_answer();

/// Answer with the facts of the proof that the first screen of a page does not show.
document::AnswerDescription<Tuning> proof_answer();

/// Line printed before the proof: what a drive engineer would refuse of the values that are to be proven.
std::string sanity_line(const Tuning& tuning);

/// All extras of `tune`, in the order of the answer. A new extra is a new file and a row in this list.
const std::vector<tuning::Extra>& all_extras();

/// Additional controller.delay that the goals bear. If a goal is missed: its rate with a wider band.
struct MoreDelay {
  /// [setting] controller.delay of the tuned study, samples; empty if missed.
  std::vector<double> delays{};
  /// Additional delay at which a goal seems lost, samples, to 0.05. Nothing if no goal is lost up to
  /// max_more.
  std::optional<double> lost{};
  std::size_t claim{0};                     ///< Index in Aim::claims of the lost claim.
  std::optional<double> wider_band_rate{};  ///< Rate of the worst goal with a band that is one count wider.
};

/// Range of a free parameter in which all goals seem to be met in all settings. The other parameters
/// have their tuned values.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
  /// Indices in Aim::claims of the claims that are lost first beyond each end. Nothing if this is the end of
  /// the parameter's range.
  std::optional<std::size_t> lost_below{}, lost_above{};
};

/// A simpler or different control at its own best values.
struct Alternative {
  std::string name;  ///< "controller.kd = 0", "observer added"
  std::vector<std::pair<std::string, double>> fixed;
  std::vector<std::pair<std::string, double>> gains;  ///< Tuned values; empty if none keep the margins.
  std::optional<goal::Verdict> verdict{};             ///< Verdict on machines that its search did not use.
  double criterion{0.0};                              ///< Criterion on these machines.
  tuning::ClaimNames worst{};
};

using Items = document::Description<Tuning>;

/// Values by the names of their parameters.
NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values);

/// The goal that most of the answer describes: the worst goal of the proof.
const study::Goal& worst_goal(const Tuning& tuning);

/// Item for the criterion of tried points.
document::Item criterion_item();

/// Title of the minimised quantity, such as "band_settling_time.p95 (s)".
std::string criterion_title(const study::Study& study);

/// Result of an extra, found by its type; an empty one if the extra did not run.
template <class Found>
const Found& found_by_extra(const Tuning& tuning) {
  static const Found none{};
  const Found* const found = tuning.answer.extra<Found>();
  return found == nullptr ? none : *found;
}

/// Whether figures are drawn. They are drawn on a page after the proof.
bool is_drawn(const Tuning& tuning);

/// Headline such as "met: the goal is met by controller.ki = 5000", or a headline that nothing is proven.
std::string tune_headline(const Tuning& tuning);
/// Headline of a page. It leaves out the values because the page shows them below.
std::string page_headline(const Tuning& tuning);

void add_refusals(Items& items);
void add_proof(Items& items);
/// Adds the facts of the proof that are not in the table of add_proof().
void add_proof_facts(Items& items);
void add_behaviour(Items& items);
void add_margins(Items& items);
/// Adds the margins as a table for people. Each margin is shown with its worst loop.
void add_margin_table(Items& items);
void add_nearest(Items& items);

/// Page of a tuning without its sections.
report::ReportPage frame_of(const study::Study& study);

/// State of a running search, for its section on a page.
struct SearchMoment {
  const study::Study& study;
  const tuning::SearchProgress& progress;
  std::string spent;  ///< Text of the spent budget.
};

/// Section with the best values so far and the uncertainty of their rate.
report::PageSection search_section(const SearchMoment& moment);

/// Sections of the proven answer and of the finished extras, each under its question.
std::vector<report::PageSection> tuning_sections(const Tuning& tuning);

/// HTML of the tuned margins of a file with one design point, including the spread that tuning adds. Empty
/// for a study without a section `tune`.
std::string tuned_margins(const reading::AllTrialsFile& file);

/// Page with the sections of a tuning, their figures and the search, followed by the report on the results
/// file of the proof if there is one.
report::ReportPage tuning_page(Tuning tuning);

}  // namespace zerocount::design_commands
