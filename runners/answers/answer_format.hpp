#pragma once

#include <string>
#include <string_view>

#include "analysis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

/// The formats in which commands answer.
namespace zerocount::answers {

/// `--format` of a command that answers: text, json, markdown, html, csv, then `more`. `table` is another
/// name of `text`. `notebook` is for the Python package: JSON with the members "answer" (the JSON), "schema"
/// (its schema), "text" and "html".
command_line::OptionSpec format_option(std::vector<std::string> more = {});

/// The format JSON on one line, for commands that answer again and again.
inline constexpr std::string_view json_line = "json_line";

/// The answer in a format of format_option(), or as json_line.
/// @throws Failure (machine_failed) for HTML with figures, if the program was built without the libraries for
/// drawing
std::string rendered(const document::Answer& answer, std::string_view format);

/// Writes the answer to standard output in the format that the arguments ask for. @returns its exit code
ExitCode print(const command_line::Arguments& arguments, const document::Answer& answer);

/// For whom the format is.
document::Audience audience_of(std::string_view format);

/// Likewise of the subject: what the format does not show is not computed.
template <class Subject>
ExitCode print(const command_line::Arguments& arguments,
               const document::AnswerDescription<Subject>& description, const Subject& subject,
               ExitCode exit_code = ExitCode::success) {
  return print(arguments, description.of(subject, exit_code, audience_of(arguments.choice("format"))));
}

}  // namespace zerocount::answers
