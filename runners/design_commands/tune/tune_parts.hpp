#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/design_commands/worst_command.hpp"

/// The parts of an answer of `tune`, each added to the items of the whole.
namespace zerocount::design_commands {

using Of = const Tuning&;
using Items = document::Description<Tuning>;

/// Values by the names of their parameters.
NamedValues named(const std::vector<study::FreeParameter>& free, const tuning::Values& values);

/// The goal of which most of the answer is: the worst by the proof.
const study::Goal& worst_goal(Of tuning);

/// " 'small' under condition loaded": a claim (Aim::claims), as far as there are several goals, and
/// conditions.
std::string claim_text(const study::Study& study, std::size_t claim);

/// The criterion of tried points.
document::Item criterion_item();

/// "band_settling_time.p95 (s)": the quantity that is minimised.
std::string criterion_title(const study::Study& study);

/// What the extra of this type has found; an empty value if it was not made.
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
/// The same for a page that shows the values below it.
std::string page_headline(Of tuning);

void add_refusals(Items& items);
void add_proof(Items& items);
/// What people are shown of add_proof() beside its table.
void add_proof_sentences(Items& items);
void add_behaviour(Items& items);
void add_margins(Items& items);
/// The margins as a table for people, each with the loop that has the worst.
void add_margin_table(Items& items);
void add_nearest(Items& items);

}  // namespace zerocount::design_commands
