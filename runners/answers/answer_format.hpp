#pragma once

#include <string>
#include <string_view>

#include "analysis/basis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

/// Output formats of the commands' answers.
namespace zerocount::answers {

/// Option `--format` of a command that answers. Its words are text, json, markdown, html, csv, then `more`.
/// `table` is another name of `text`. `notebook` is for the Python package: JSON with the members "answer"
/// (the JSON answer), "schema" (the schema of this answer), "text" and "html".
command_line::OptionSpec format_option(std::vector<std::string> more = {});

/// Format of an answer: JSON on one line, for commands that print their answer repeatedly.
inline constexpr std::string_view json_line = "json_line";

/// Renders the answer of a command as text in one of the formats of format_option(), or as json_line.
/// @throws Failure (machine_failed) for HTML with figures, if the program was built without the libraries for
/// drawing
std::string rendered(const document::Answer& answer, std::string_view format);

/// Writes the answer to standard output in the format that the arguments ask for.
/// @returns the exit code of the answer
ExitCode print(const command_line::Arguments& arguments, const document::Answer& answer);

/// Audience for which a format is meant: people or data.
document::Audience audience_of(std::string_view format);

/// Describes `subject` and writes the answer to standard output in the format that the arguments ask for.
/// Items that this format does not show are not computed.
/// @returns `exit_code`
template <class Subject>
ExitCode print(const command_line::Arguments& arguments,
               const document::AnswerDescription<Subject>& description, const Subject& subject,
               ExitCode exit_code = ExitCode::success) {
  return print(arguments, description.of(subject, exit_code, audience_of(arguments.choice("format"))));
}

}  // namespace zerocount::answers
