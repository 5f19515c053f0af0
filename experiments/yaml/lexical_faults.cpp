#include "experiments/yaml/faults.hpp"

namespace zerocount::yaml {
namespace {

constexpr std::string_view flow_indicators = ",[]{}";

bool is_one_of(char c, std::string_view characters) {
  return characters.find(c) != std::string_view::npos;
}

/// Reads the tokens of a document only as far as is needed to know where quoted texts begin.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) at_ = line_ = byte_order_mark.size();
  }

  std::optional<LexicalFault> run() {
    check_indentation();
    while (!fault_ && !ends_at(at_)) step();
    return fault_;
  }

 private:
  static constexpr std::size_t npos = std::string_view::npos;

  bool ends_at(std::size_t at) const { return at >= text_.size(); }
  char char_at(std::size_t at) const { return ends_at(at) ? '\n' : text_[at]; }
  bool is_blank_at(std::size_t at) const { return is_one_of(char_at(at), " \t\r\n"); }
  bool in_flow() const { return depth_ > 0; }
  int column(std::size_t at) const { return static_cast<int>(at - line_); }
  bool starts_comment(std::size_t at) const {
    return char_at(at) == '#' && (at == line_ || is_blank_at(at - 1));
  }

  void refuse(std::size_t at, std::string_view what, std::string_view expected) {
    if (!fault_) fault_ = {at, what, expected};
  }
  void refuse_unclosed(std::size_t at) {
    refuse(at, "unclosed quotation mark",
           "a closing one on the same line, or after lines that are indented more than the key");
  }

  // The first character after the spaces of a line that starts here.
  std::size_t after_spaces(std::size_t at) const {
    const std::size_t found = text_.find_first_not_of(' ', at);
    return found == npos ? text_.size() : found;
  }
  std::size_t after_blanks(std::size_t at) const {
    const std::size_t found = text_.find_first_not_of(" \t\r", at);
    return found == npos ? text_.size() : found;
  }
  std::size_t end_of_line(std::size_t at) const {
    const std::size_t found = text_.find('\n', at);
    return found == npos ? text_.size() : found;
  }

  // Goes to the line that starts at `at`.
  void start_line(std::size_t at) {
    at_ = line_ = at;
    node_.reset();
  }

  void check_indentation() {
    const std::size_t spaces = after_spaces(at_);
    const std::size_t word = after_blanks(at_);
    if (char_at(spaces) == '\t' && char_at(word) != '\n' && char_at(word) != '#')
      refuse(spaces, "tab in the indentation", "spaces");
  }

  // The column of the node that starts here, or has started on this line with an anchor or a tag.
  void note_node() {
    if (!node_) node_ = column(at_);
  }

  // The key or the entry of a list that starts in this column owns what follows.
  void start_value(int column) {
    owner_ = column;
    node_.reset();
    ++at_;
  }

  void step() {
    const char c = text_[at_];
    if (c == '\n') {
      start_line(at_ + 1);
      if (!in_flow()) check_indentation();
    } else if (is_blank_at(at_)) {
      ++at_;
    } else if (starts_comment(at_)) {
      at_ = end_of_line(at_);
    } else if (at_ == line_ && !in_flow() && skip_document_line()) {
      return;
    } else if (is_one_of(c, "\"'")) {
      read_quoted();
    } else if (is_one_of(c, "&*!")) {
      note_node();
      skip_property();
    } else if (is_one_of(c, "[{")) {
      note_node();
      ++depth_;
      ++at_;
    } else if (in_flow()) {
      step_in_flow(c);
    } else {
      step_in_block(c);
    }
  }

  // An anchor, an alias or a tag. It has no quotation mark: yaml-cpp begins a text right after a lone '!'.
  void skip_property() {
    for (; !is_blank_at(at_) && !(in_flow() && is_one_of(text_[at_], flow_indicators)); ++at_) {
      if (!is_one_of(text_[at_], "\"'")) continue;
      refuse(at_, "quotation mark in an anchor or a tag", "a blank before a text in quotation marks");
      return;
    }
  }

  // Directives, and the marks of documents.
  bool skip_document_line() {
    const std::string_view mark = text_.substr(at_, 3);
    if ((mark == "---" || mark == "...") && is_blank_at(at_ + 3)) {
      owner_ = -1;
      at_ += 3;
      return true;
    }
    if (text_[at_] != '%') return false;
    at_ = end_of_line(at_);
    return true;
  }

  void step_in_flow(char c) {
    if (is_one_of(c, "]}")) --depth_;
    if (is_one_of(c, flow_indicators) || (is_one_of(c, "?:") && ends_word_in_flow(at_ + 1))) {
      ++at_;
    } else {
      read_plain_in_flow();
    }
  }

  void step_in_block(char c) {
    if (is_one_of(c, "-?") && is_blank_at(at_ + 1)) {
      start_value(column(at_));
    } else if (c == ':' && is_blank_at(at_ + 1)) {
      start_value(node_.value_or(column(at_)));
    } else if (is_one_of(c, "|>")) {
      skip_block_scalar();
    } else {
      read_plain_in_block();
    }
  }

  bool ends_word_in_flow(std::size_t at) const {
    return is_blank_at(at) || is_one_of(char_at(at), flow_indicators);
  }

  void read_plain_in_flow() {
    for (; !ends_at(at_); ++at_) {
      const char c = text_[at_];
      if (is_one_of(c, flow_indicators) || starts_comment(at_)) return;
      if (c == ':' && ends_word_in_flow(at_ + 1)) return;
      if (c == '\n') line_ = at_ + 1;
    }
  }

  // The start of the next line that is not empty, if it continues a scalar of this owner.
  std::optional<std::size_t> continuation(std::size_t end) const {
    while (!ends_at(end)) {
      const std::size_t start = end + 1;
      const std::size_t word = after_spaces(start);
      end = end_of_line(start);
      if (after_blanks(start) < end) {
        if (static_cast<int>(word - start) > owner_) return start;
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  void skip_block_scalar() {
    at_ = end_of_line(at_);
    while (const auto next = continuation(at_)) at_ = end_of_line(*next);
    if (!ends_at(at_)) line_ = text_.rfind('\n', at_ - 1) + 1;
  }

  void read_plain_in_block() {
    const std::size_t start = at_;
    const bool at_indentation_of_keys = after_spaces(line_) == start && column(start) <= owner_;
    note_node();
    while (true) {
      for (; char_at(at_) != '\n' && !starts_comment(at_); ++at_) {
        if (text_[at_] == ':' && is_blank_at(at_ + 1)) return;
      }
      if (at_indentation_of_keys) {
        refuse(start, "a text without the colon and the blank that follow a key", "key: value");
        return;
      }
      const auto next = char_at(at_) == '\n' ? continuation(at_) : std::nullopt;
      if (!next || char_at(after_spaces(*next)) == '#') return;
      line_ = *next;
      at_ = after_blanks(*next);
    }
  }

  // The closing quotation mark of the text that starts at at_; npos if there is none.
  std::size_t end_of_quoted() const {
    const char quote = text_[at_];
    for (std::size_t at = at_ + 1; !ends_at(at); ++at) {
      if (quote == '"' && text_[at] == '\\') {
        ++at;
      } else if (text_[at] == quote) {
        if (quote == '"' || char_at(at + 1) != quote) return at;
        ++at;
      }
    }
    return npos;
  }

  void read_quoted() {
    const std::size_t start = at_;
    note_node();
    const std::size_t close = end_of_quoted();
    if (close == npos) return refuse_unclosed(start);
    const std::size_t first_line = line_;
    while (end_of_line(line_) < close) {
      line_ = end_of_line(line_) + 1;
      const std::size_t word = after_spaces(line_);
      const bool is_empty = word == close || is_one_of(char_at(word), "\t\r\n");
      if (column(word) <= owner_ && !is_empty) return refuse_unclosed(start);
    }
    at_ = close + 1;
    const std::size_t next = after_blanks(at_);
    const bool ends = is_one_of(char_at(next), "\n#:") || (in_flow() && is_one_of(char_at(next), ",]}"));
    if (line_ != first_line && (!ends || char_at(next) == ':')) return refuse_unclosed(start);
    if (!ends) {
      refuse(next, "text after the closing quotation mark",
             in_flow() ? "a comma or a closing bracket" : "the end of the line");
    }
  }

  std::string_view text_;
  std::size_t at_{0};
  std::size_t line_{0};        // start of the line of at_
  int depth_{0};               // of lists and maps in flow style
  int owner_{-1};              // column of the key or list entry to which a scalar belongs
  std::optional<int> node_{};  // column of the node that has started on this line
  std::optional<LexicalFault> fault_{};
};

}  // namespace

std::optional<LexicalFault> first_lexical_fault(std::string_view text) {
  return Lexer(text).run();
}

}  // namespace zerocount::yaml
