#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <slideway/io/text.hpp>
#include <system_error>

namespace slideway::io {
namespace {

bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Levenshtein's: insertions, deletions and replacements, one row at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

bool is_name(std::string_view text) noexcept {
  return !text.empty() && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

std::string printable(std::string_view text, std::size_t most) {
  std::string shown{text.substr(0, most)};
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text.size() > most ? shown + "..." : shown;
}

std::string quote(std::string_view text) {
  std::string quoted = "'";
  quoted += printable(text, 60);
  return quoted += '\'';
}

std::string nearest(std::string_view text, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 60;  // nobody mistypes more; keeps the cost of hostile files linear
  if (text.size() > longest) return {};
  std::string best;
  std::size_t least = std::max<std::size_t>(1, text.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(text, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(std::string_view text, const std::vector<std::string>& candidates) {
  constexpr std::size_t most = 24;
  if (const std::string near = nearest(text, candidates); !near.empty()) return "; did you mean " + quote(near) + "?";
  std::string list;
  for (std::size_t i = 0; i < candidates.size() && i < most; ++i) {
    list += (i == 0 ? "; there are: " : ", ") + printable(candidates[i], 60);
  }
  return candidates.size() > most ? list + ", ..." : list;
}

std::string fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

FileText read_text(const std::string& file, std::size_t limit) {
  std::error_code error;
  if (file != "-" && std::filesystem::is_directory(file, error)) return {{}, "is a directory; name a file in it"};
  const auto close = [](std::FILE* stream) {
    if (stream != nullptr && stream != stdin) std::fclose(stream);
  };
  const std::unique_ptr<std::FILE, decltype(close)> stream(file == "-" ? stdin : std::fopen(file.c_str(), "rb"), close);
  if (!stream) return {{}, "cannot be read: " + std::generic_category().message(errno)};
  FileText result;
  result.text.resize(limit + 1);
  result.text.resize(std::fread(result.text.data(), 1, limit + 1, stream.get()));
  if (std::ferror(stream.get()) != 0) return {{}, "cannot be read: " + std::generic_category().message(errno)};
  if (result.text.size() > limit) return {{}, fmt::format("has more than {} KiB", limit / 1024)};
  return result;
}

}  // namespace slideway::io
