#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/description.hpp"
#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/tuner.hpp"

/// Parts of the answer of the command `tune`. Each part is added to the items of the whole answer.
namespace zerocount::design_commands {

using tuning::Tuning;

/// Description of the first part of the answer: the verdict, the proof and the behaviour of the moves. It is
/// printed before the extras are computed.
document::AnswerDescription<Tuning> proven_answer();

/// Description of the part of the answer that one extra adds, such as the causes of failures.
document::AnswerDescription<Tuning> extra_answer(const tuning::Extra& extra);

/// Description of the last part of the answer: the spent effort and the parts that were left out.
document::AnswerDescription<Tuning> closing_answer();

/// Description of the complete answer of `tune`, with figures.
document::AnswerDescription<Tuning> tune_answer();

/// Description of an answer with the stability margins of the tuned loops as a table, for the first screen of
/// a page.
document::AnswerDescription<Tuning> margins_answer();

/// Description of an answer with the facts of the proof that the first screen of a page does not show.
document::AnswerDescription<Tuning> proof_answer();

/// Line of text printed before the proof: what a drive engineer would refuse in the behaviour of the values
/// that are to be proven.
std::string sanity_line(const Tuning& tuning);

/// All extras (optional parts of the answer) of `tune`, in the order of the answer. A new extra is a new file
/// and a row in this list.
const std::vector<tuning::Extra>& all_extras();

/// Result of an extra: the additional delay of the controller at which the goals are still met. If a goal is
/// missed already: its success rate with a wider band.
struct MoreDelay {
  /// [setting] controller.delay of the tuned study in each setting (condition at an age), samples; empty if a
  /// goal is missed.
  std::vector<double> delays{};
  /// Additional delay at which a goal seems lost, samples, to 0.05. Nothing if no goal is lost up to the
  /// largest delay tried.
  std::optional<double> lost{};
  std::size_t claim{0};  ///< Index in Aim::claims of the claim (goal in a setting) that is lost first.
  /// Success rate of the worst goal with a band that is one count wider; nothing if all goals are met.
  std::optional<double> wider_band_rate{};
};

/// Range of a free parameter in which all goals seem to be met in all settings (conditions at ages). The
/// other parameters have their tuned values.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
  /// Indices in Aim::claims of the claims (goals in settings) that are lost first below `low` and above
  /// `high`. Nothing if this is the end of the parameter's range.
  std::optional<std::size_t> lost_below{}, lost_above{};
};

/// A simpler or different control law with its own best values, for comparison with the tuned one.
struct Alternative {
  std::string name;  ///< Text such as "controller.kd = 0" or "observer added".
  std::vector<std::pair<std::string, double>> fixed;
  /// Names and tuned values of its parameters; empty if no values keep the stability margins.
  std::vector<std::pair<std::string, double>> gains;
  /// Verdict on the goals, from machines that its search did not use; nothing without values.
  std::optional<goal::Verdict> verdict{};
  /// Criterion, the quantity that the tuning minimises, on these machines; infinity for "never".
  double criterion{0.0};
  tuning::ClaimNames worst{};
};

using Items = document::Description<Tuning>;

/// Pairs of the free parameters' dotted paths and their values.
NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values);

/// The goal that most of the answer describes: the worst goal of the proof.
const study::Goal& worst_goal(const Tuning& tuning);

/// Description of the column with the criterion of tried points, the quantity that the tuning minimises.
document::Item criterion_item();

/// Title of the quantity that the tuning minimises, with its unit, such as "band_settling_time.p95 (s)".
std::string criterion_title(const study::Study& study);

/// Result of the extra of the answer that returns this type; an empty object if the extra did not run.
template <class Found>
const Found& found_by_extra(const Tuning& tuning) {
  static const Found none{};
  const Found* const found = tuning.answer.extra<Found>();
  return found == nullptr ? none : *found;
}

/// Whether figures are drawn: the answer goes to a page, and there is a proof.
bool is_drawn(const Tuning& tuning);

/// First line of the answer, such as "met: the goal is met by controller.ki = 5000", or a line that says that
/// nothing is proven.
std::string tune_headline(const Tuning& tuning);
/// Headline of a page with the answer. It leaves out the values because the page shows them below.
std::string page_headline(const Tuning& tuning);

void add_refusals(Items& items);
void add_proof(Items& items);
/// Adds to the description the facts of the proof that are not in the table of add_proof().
void add_proof_facts(Items& items);
void add_behaviour(Items& items);
void add_margins(Items& items);
/// Adds to the description the stability margins as a table for people. Each margin is shown with its worst
/// loop.
void add_margin_table(Items& items);
void add_nearest(Items& items);

/// Page of a tuning with title and subtitle, without its sections.
report::ReportPage frame_of(const study::Study& study);

/// State of a running search for the best values, for its section on a page.
struct SearchMoment {
  const study::Study& study;
  const tuning::SearchProgress& progress;
  std::string spent;  ///< Text of the part of the budget that is spent, such as "21 of 60 s".
};

/// Section of a page with the best values that a running search has found so far, and the bounds of their
/// success rate.
report::PageSection search_section(const SearchMoment& moment);

/// Sections of a page: the proven answer, and each finished extra under its question.
std::vector<report::PageSection> tuning_sections(const Tuning& tuning);

/// HTML text with the stability margins of the values in a results file with one design point, including the
/// spread that the tuning adds. Empty for a study without a section `tune`.
std::string tuned_margins(const reading::AllTrialsFile& file);

/// Page with the sections of a tuning, their figures and the state of its search, followed by the report on
/// the results file of the proof if there is one.
report::ReportPage tuning_page(Tuning tuning);

}  // namespace zerocount::design_commands
