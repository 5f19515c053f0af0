#include "runners/answers/answer_format.hpp"

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/report_json.hpp"
#include "analysis/report/page.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/terminal/terminal.hpp"

namespace zerocount::answers {
namespace {

nlohmann::ordered_json notebook_json(const document::Answer& answer) {
  return {{"answer", document::json(answer)},
          {"schema", document::json_schema(answer.type)},
          {"text", document::text(answer)},
          {"html", document::html(answer)}};
}

}  // namespace

command_line::OptionSpec format_option(std::vector<std::string> more) {
  std::vector<std::string> formats{"text", "json", "markdown", "html", "csv"};
  formats.insert(formats.end(), more.begin(), more.end());
  command_line::OptionSpec option = command_line::format_option(std::move(formats));
  option.other_names = {{"table", "text"}, {"notebook", "notebook"}};
  return option;
}

std::string rendered(const document::Answer& answer, std::string_view format) {
  if (format == "json") return document::json_text(answer);
  if (format == json_line) return document::json_text(answer, text::one_line);
  if (format == "markdown") return document::markdown(answer);
  if (format == "html") return report::html_page(report::answer_page(answer));
  if (format == "csv") return document::csv(answer);
  if (format == "notebook") return text::json_text(notebook_json(answer), text::one_line);
  return document::text(answer);
}

document::Audience audience_of(std::string_view format) {
  if (format == "json") return document::Audience::json;
  if (format == "csv") return document::Audience::csv;
  if (format == "notebook") return document::Audience::all;
  return document::Audience::people;
}

ExitCode print(const command_line::Arguments& arguments, const document::Answer& answer) {
  const std::string format = arguments.choice("format");
  if (format == "json") {
    document::write_json(answer, 2, [](std::string_view piece) { standard_output::write(piece); });
  } else if (format == "text") {
    standard_output::write(document::text(answer, terminal::width_of(STDOUT_FILENO)));
  } else {
    standard_output::write(rendered(answer, format));
  }
  return answer.exit_code;
}

}  // namespace zerocount::answers
