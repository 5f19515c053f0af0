#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace zerocount {

/// A place in a text, as messages give it.
struct TextPlace {
  int line{1};    ///< from 1
  int column{1};  ///< from 1, in bytes
  bool operator==(const TextPlace&) const = default;
};

/// A text and the places that were marked in it.
struct MarkedText {
  std::string text;               ///< without the marks
  std::vector<TextPlace> places;  ///< starts of the marked parts, in the order of the text
};

/// Reads a text in which parts are marked with «…», so that a test need not count the lines and columns where
/// it expects a message. A message stands at the start of a mark; the end is for readers. A mark may be
/// empty, and may lie in another one.
/// @throws std::invalid_argument for a mark that is not closed, or not opened.
MarkedText marked_text(std::string_view text);

/// The message of a program about a text, with marks in place of lines and columns: "m.yaml:6:18: plant"
/// becomes "m.yaml:«»: plant" if the only mark of the text starts there. If there are several marks, it
/// becomes "m.yaml:«2»: plant" at the second one. Places that are not marked stay.
/// @param name name of the text in the message
std::string with_marks(std::string message, std::string_view name, const MarkedText& text);

}  // namespace zerocount
