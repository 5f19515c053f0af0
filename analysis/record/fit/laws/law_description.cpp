#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/report.hpp"
#include "core/friction/law.hpp"

namespace zerocount::fit {

namespace {

using document::in_data;

/// Difference of the Bayesian information criterion between two laws that counts as strong evidence (Kass &
/// Raftery, J. Am. Stat. Assoc. 90, 1995, 773: 6 to 10 strong, above 10 very strong).
constexpr double strong_evidence = 10.0;

std::string_view to_string(const IdentifiedLaw& law) {
  return friction::traits_of(law.law).word;
}

/// Text that says by how much the best friction law that explains the records leads over the next one that
/// does.
std::string lead_of(const LawComparison& comparison) {
  const IdentifiedLaw& best = comparison.laws.front();
  const IdentifiedLaw& next = comparison.laws[1];
  if (!next.checks.passed)
    return fmt::format("{} explains the records, and no other of these {} laws was found to", to_string(best),
                       comparison.laws.size());
  if (next.information_criterion > strong_evidence)
    return fmt::format("{} explains the records best; {} is next, {:.0f} higher in BIC", to_string(best),
                       to_string(next), next.information_criterion);
  return fmt::format(
      "{} explains the records; the BIC of {} and {} differ by {:.1f} only: the records do not distinguish "
      "them",
      to_string(best), to_string(best), to_string(next), next.information_criterion);
}

/// Headline of the answer: the friction law that explains the records best or, if none explains them, the
/// nearest one.
std::string laws_headline(const LawComparison& comparison) {
  const IdentifiedLaw& best = comparison.laws.front();
  const bool alone = comparison.laws.size() == 1;
  if (!best.checks.passed)
    return fmt::format("LACK OF FIT: {} was found to explain the records{}: {}",
                       alone ? fmt::format("no fit of {}", to_string(best)) : "none of these laws",
                       alone ? "" : fmt::format("; {} is the nearest", to_string(best)),
                       reason_of_misfit(best.checks));
  return alone ? fmt::format("{} explains the records", to_string(best)) : lead_of(comparison);
}

/// Text with the friction laws that could not be fitted, one per line.
std::string laws_left_out_text(const LawComparison& comparison) {
  std::string text;
  for (const LawLeftOut& law : comparison.left_out)
    text += fmt::format("{} is left out, which says nothing about the contact: {}\n",
                        friction::traits_of(law.law).word, text::printable(law.reason));
  return text;
}

/// Text with the parts that were left out of the records, one line for each record.
std::string left_out_of_records_text(const LawComparison& comparison) {
  std::string text;
  for (const RecordExtent& record : comparison.records) {
    const std::string name = text::printable(record.name);
    if (!record.note.empty()) text += fmt::format("{}: {}\n", name, record.note);
    if (record.excluded > 0)
      text += fmt::format("{}: {} samples masked by --exclude\n", name, record.excluded);
  }
  return text;
}

std::string missing_text(const LawComparison& comparison) {
  const IdentifiedLaw& best = comparison.laws.front();
  return missing_parameters_text(best.parameters) +
         (best.converged ? "" : "The fit to all readings did not converge within its steps.");
}

document::Description<IdentifiedLaw> law_description() {
  return document::Description<IdentifiedLaw>()
      .value({"law", "law", "word of the friction law"}, [](const IdentifiedLaw& r) { return to_string(r); })
      .value({"fitted", "fitted", "fitted numbers, with the time offset"}, &IdentifiedLaw::fitted)
      .value(for_people("residual", "residual"),
             [](const IdentifiedLaw& r) { return length_text(r.misfit, r.axis); })
      .value(for_people("of_travel", "of the travel"),
             [](const IdentifiedLaw& r) { return fmt::format("{:.3g} %", 100.0 * r.misfit_over_travel); })
      .value(in_data("misfit", "root mean square of the residuals, rad or m"), &IdentifiedLaw::misfit)
      .value(in_data("misfit_over_travel", "the same over the travel of the records", "1"),
             &IdentifiedLaw::misfit_over_travel)
      .value(
          {"bic_above_least", "BIC − best",
           "Schwarz's criterion less that of the best law, the first one; negative for one that does not explain the records"},
          &IdentifiedLaw::information_criterion)
      .value({"explained", "encoder and noise explain it", "whether they explain the residuals"},
             [](const IdentifiedLaw& r) { return r.checks.passed; })
      .value(in_data("spread", "root mean square of the residuals over their standard deviations", "1"),
             [](const IdentifiedLaw& r) { return r.checks.spread; })
      .value(in_data("expected_spread", "its mean over replicates", "1"),
             [](const IdentifiedLaw& r) { return r.checks.expected_spread; })
      .value(in_data("widening", "factor that widened the intervals", "1"),
             [](const IdentifiedLaw& r) { return r.checks.widening; })
      .value(in_data("converged", "whether the fit converged"), &IdentifiedLaw::converged)
      .table(in_data("parameters", "its parameters"), estimate_description(), &IdentifiedLaw::parameters)
      .value(in_data("manifest", "the law as a fragment of a manifest"), &IdentifiedLaw::fragment);
}

document::Description<LawLeftOut> left_out_description() {
  return document::Description<LawLeftOut>()
      .value(in_data("law", "word of the friction law"),
             [](const LawLeftOut& l) { return friction::traits_of(l.law).word; })
      .value(in_data("reason", "why it could not be fitted"),
             [](const LawLeftOut& l) { return text::printable(l.reason); });
}

document::Description<RecordExtent> law_record_description() {
  return document::Description<RecordExtent>()
      .value(in_data("name", "file, and part of it"),
             [](const RecordExtent& r) { return text::printable(r.name); })
      .value(in_data("samples", "samples of the record"), &RecordExtent::samples)
      .value(in_data("excluded", "samples masked by --exclude"), &RecordExtent::excluded)
      .value(in_data("note", "what was cut out of it"),
             [](const RecordExtent& r) { return text::printable(r.note); });
}

}  // namespace

document::AnswerDescription<LawComparison> laws_answer() {
  document::AnswerDescription<LawComparison> answer{
      {.name = "identify-laws", .meaning = "friction laws compared on the same records", .csv_table = "laws"},
      {}};
  answer.items.headline(laws_headline)
      .value(in_data("kind", "always laws"), [](const LawComparison&) { return "laws"; })
      .value(
          axis_item(),
          [](const LawComparison& c) { return parameters::axis_labels.at(static_cast<std::size_t>(c.axis)); })
      .table({.key = "laws", .meaning = "the laws, the best one first"}, law_description(),
             &LawComparison::laws)
      .table(in_data("left_out", "laws that could not be fitted"), left_out_description(),
             &LawComparison::left_out)
      .sentence(laws_left_out_text)
      .value(in_data("readings", "readings of all records"), &LawComparison::readings)
      .value(in_data("effective_readings", "those that count as independent in BIC"),
             &LawComparison::effective_readings)
      .sentence([](const LawComparison& c) {
        return fmt::format("{} readings, of which {:.0f} count as independent in BIC", c.readings,
                           c.effective_readings);
      })
      .value(in_data("sample_time", "time between samples", "s"), &LawComparison::sample_time)
      .table(in_data("records", "the records"), law_record_description(), &LawComparison::records)
      .sentence(left_out_of_records_text)
      .table(
          {.key = "best", .heading = "Parameters of the best law", .shown = document::Visibility::to_people},
          estimate_description(), [](const LawComparison& c) { return c.laws.front().parameters; })
      .sentence(missing_text)
      .value(fragment_item(), [](const LawComparison& c) { return c.laws.front().fragment; });
  return answer;
}

}  // namespace zerocount::fit
