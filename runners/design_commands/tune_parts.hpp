#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "runners/design_commands/tune_answer.hpp"
#include "runners/design_commands/worst_command.hpp"
#include "runners/tuning/tuner.hpp"

/// The parts of an answer of `tune`, each added to the items of the whole.
namespace zerocount::design_commands {

using Of = const Tuning&;

inline constexpr goal::Status all_statuses[] = {goal::Status::met, goal::Status::missed,
                                                goal::Status::undecided};

/// Values by the names of their parameters.
NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values);

/// The goal of which most of the answer is: the worst by the proof.
const study::Goal& worst_goal(Of tuning);

/// " 'small'": the goal of a claim, of several goals.
std::string several_goal_text(const study::Study& study, std::size_t claim);

/// The criterion of tried points.
document::Item criterion_item();

/// "met: the goal is met by controller.ki = 5000", or that nothing is proven.
std::string tune_headline(Of tuning);
/// The same for a page that shows the values below it.
std::string page_headline(Of tuning);

void add_refusals(document::Description<Tuning>& items);
void add_proof(document::Description<Tuning>& items);
/// The sentences of add_proof().
void add_proof_sentences(document::Description<Tuning>& items);
void add_behaviour(document::Description<Tuning>& items);
void add_margins(document::Description<Tuning>& items);
/// The margins as a table for a page, each with the loop that has the worst.
void add_margin_table(document::Description<Tuning>& items);
void add_nearest(document::Description<Tuning>& items);
void add_delay(document::Description<Tuning>& items);
void add_lost_ages(document::Description<Tuning>& items);
void add_room(document::Description<Tuning>& items);
void add_robustness(document::Description<Tuning>& items);
void add_retuning(document::Description<Tuning>& items);
void add_controls(document::Description<Tuning>& items);
void add_limits(document::Description<Tuning>& items);
void add_frontier(document::Description<Tuning>& items);

}  // namespace zerocount::design_commands
