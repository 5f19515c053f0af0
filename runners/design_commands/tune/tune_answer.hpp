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

/// The parts of an answer of `tune`, each added to the items of the whole.
namespace zerocount::design_commands {

using tuning::Tuning;

/// Adds the verdict, the proof and the behaviour of the moves, which are printed before the extras are made.
document::AnswerDescription<Tuning> proven_answer();

/// One extra, by simulation.
document::AnswerDescription<Tuning> extra_answer(const tuning::Extra& extra);

/// The effort, and what was left out.
document::AnswerDescription<Tuning> closing_answer();

/// All of it, with figures.
document::AnswerDescription<Tuning> tune_answer();

/// The margins of the tuned loops as a table, for the first screen of a page.
document::AnswerDescription<Tuning> margins_answer();

/// What a page with that first screen does not show yet of the proof.
document::AnswerDescription<Tuning> proof_answer();

/// Before the proof: what a drive engineer would refuse of the values that are to be proven, in one line.
std::string sanity_line(const Tuning& tuning);

/// The extras of `tune`, in the order of what they tell. A new one is its file and its row here.
const std::vector<tuning::Extra>& all_extras();

/// How much more of controller.delay a goal bears; of a goal that is missed what a wider band would change.
struct MoreDelay {
  std::vector<double> delays{};  ///< [condition] controller.delay of the tuned study, samples; none if missed
  std::optional<double> lost{};  ///< more of it, by which a goal seems lost, to 0.05; nothing up to max_more
  std::size_t claim{0};          ///< of Aim::claims that is lost
  std::optional<double> wider_band_rate{};  ///< of the worst goal, with a band one count wider
};

/// Range of a free parameter, the others as tuned, in which all goals seem to be met under all conditions.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
  /// The claims (Aim::claims) that are lost first beyond the ends; nothing at the end of the range.
  std::optional<std::size_t> lost_below{}, lost_above{};
};

/// A simpler or another control at its own best values.
struct Alternative {
  std::string name;  ///< "controller.kd = 0", "observer added"
  std::vector<std::pair<std::string, double>> fixed;
  std::vector<std::pair<std::string, double>> gains;  ///< empty if none keeps the margins
  std::optional<goal::Verdict> verdict{};             ///< on machines that the search for it never saw
  double criterion{0.0};                              ///< on these machines
  tuning::ClaimNames worst{};
};

using Of = const Tuning&;
using Items = document::Description<Tuning>;

/// Values by the names of their parameters.
NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values);

/// The goal of which most of the answer is: the worst by the proof.
const study::Goal& worst_goal(Of tuning);

/// The criterion of tried points.
document::Item criterion_item();

/// "band_settling_time.p95 (s)": the quantity that is minimised.
std::string criterion_title(const study::Study& study);

/// The result of the extra of this type; an empty one if the extra did not run.
template <class Found>
const Found& found_by_extra(Of tuning) {
  static const Found none{};
  const Found* const found = tuning.answer.extra<Found>();
  return found == nullptr ? none : *found;
}

/// Whether figures are drawn: of a page, with a proof.
bool is_drawn(Of tuning);

/// "met: the goal is met by controller.ki = 5000", or that nothing is proven.
std::string tune_headline(Of tuning);
/// The headline of a page, which leaves out the values: the page shows them below it.
std::string page_headline(Of tuning);

void add_refusals(Items& items);
void add_proof(Items& items);
/// Adds what stands beside the table of add_proof().
void add_proof_facts(Items& items);
void add_behaviour(Items& items);
void add_margins(Items& items);
/// The margins as a table for people, each with the loop that has the worst.
void add_margin_table(Items& items);
void add_nearest(Items& items);

/// The page of a tuning without sections.
report::ReportPage frame_of(const study::Study& study);

/// A search that goes on.
struct SearchMoment {
  const study::Study& study;
  const tuning::SearchProgress& progress;
  std::string spent;  ///< of the budget
};

/// The best values so far, and how sure their rate is.
report::PageSection search_section(const SearchMoment& moment);

/// The proven answer, and the extras that are there, each under its question.
std::vector<report::PageSection> tuning_sections(const Tuning& tuning);

/// HTML of the margins that tuning gives the loops of its one point, with the spreads that it adds; empty for
/// a study that says nothing of tuning.
std::string tuned_margins(const reading::AllTrialsFile& file);

/// These sections with their figures, and the search; then the report on the results file of the proof, where
/// there is one.
report::ReportPage tuning_page(Tuning tuning);

}  // namespace zerocount::design_commands
