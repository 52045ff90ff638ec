// Small things about text that reading and writing share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slideway::io {

/// [A-Za-z_][A-Za-z0-9_]*
bool is_name(std::string_view text) noexcept;

/// Of the text at most `most` bytes, then "...", with what a terminal must not see replaced by '?'.
std::string printable(std::string_view text, std::size_t most);

/// 'text', printable, and cut to a length that fits a message.
std::string quote(std::string_view text);

/// The candidate that `text` was most likely meant to be; empty if none is near. By edit distance, at most a third of
/// the text's length.
std::string nearest(std::string_view text, const std::vector<std::string>& candidates);

/// "; did you mean 'x'?", else "; there are: a, b, c", else nothing.
std::string suggestion(std::string_view text, const std::vector<std::string>& candidates);

/// FNV-1a, 64 bits, as 16 hex digits: tells two scene texts apart, protects against nothing.
std::string fnv1a(std::string_view text);

/// `problem` is empty exactly when `text` is the file's content.
struct FileText {
  std::string text;
  std::string problem;
};

/// A file of at most `limit` bytes; "-" is standard input.
FileText read_text(const std::string& file, std::size_t limit);

}  // namespace slideway::io
