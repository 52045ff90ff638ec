#include "hlcp_problem.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <slideway/io/text.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "messages.hpp"

namespace slideway::app {
namespace {

using nlohmann::json;
using Row = std::vector<double>;

constexpr std::size_t most_bytes = std::size_t{1} << 20;  // order 64 needs a fifth of it
constexpr std::size_t most_of_error = 200;                // of a parser's, which quotes what it read

constexpr const char* forms =
    R"(write {"A_plus": [[..]], "A_minus": [[..]], "b": [..]} or, for w - M z = q, {"M": [[..]], "q": [..]})";

/// What follows the file's name in the message: the line, if there is one, and the sentence.
struct Defect : std::runtime_error {
  using runtime_error::runtime_error;
};

template <class... Values>
[[noreturn]] void refuse(fmt::format_string<Values...> format, Values&&... values) {
  throw Defect(": " + fmt::format(format, std::forward<Values>(values)...));
}

template <class... Values>
[[noreturn]] void refuse_line(long line, fmt::format_string<Values...> format, Values&&... values) {
  throw Defect(fmt::format(":{}: ", line) + fmt::format(format, std::forward<Values>(values)...));
}

void check_order(std::string_view what, std::size_t n) {
  if (n < 1 || n > hlcp_max_order) refuse("{} has order {}; the kernel takes orders 1 to {}", what, n, hlcp_max_order);
}

/// A+ = I, A- = M, b = q.
void enter_lcp(HlcpProblem& problem, const std::vector<Row>& m, const Row& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    problem.data.plus[i][i] = 1.0;
    std::copy(m[i].begin(), m[i].end(), problem.data.minus[i]);
    problem.data.b[i] = q[i];
  }
}

// ---- JSON

json parse(const std::string& text) {
  std::set<std::string> keys;
  const auto once = [&keys](int depth, json::parse_event_t event, json& parsed) {
    if (depth == 1 && event == json::parse_event_t::key && !keys.insert(parsed.get<std::string>()).second)
      refuse("has the key {} twice", io::quote(parsed.get<std::string>()));
    return true;
  };
  try {
    return json::parse(text, once);
  } catch (const json::parse_error& error) {
    const std::size_t before = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());  // it counts from 1
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(before);
    const std::string what = error.what();
    const std::size_t words = what.find("syntax error");
    refuse_line(1 + std::count(text.begin(), end, '\n'), "is not JSON: {}",
                words == what.npos ? "it cannot be parsed" : io::printable(what.substr(words), most_of_error));
  } catch (const json::out_of_range&) {
    refuse("has a number beyond the range of doubles, 1.8e308");
  }
}

double number(const json& value, const std::string& place) {
  if (!value.is_number()) refuse("{} must be a number, not {}", place, value.type_name());
  return value.get<double>();
}

/// A list of n numbers, for `why`.
Row numbers(const json& list, const std::string& place, std::size_t n, const std::string& why) {
  if (!list.is_array()) refuse("{} must be a list of numbers, not {}", place, list.type_name());
  if (list.size() != n) refuse("{} has {} numbers, and {}: write {}", place, list.size(), why, n);
  Row row;
  for (std::size_t j = 0; j < n; ++j) row.push_back(number(list[j], fmt::format("{}[{}]", place, j)));
  return row;
}

std::vector<Row> matrix(const json& list, const std::string& key) {
  if (!list.is_array()) refuse("{} must be a list of rows, [[..], [..]], not {}", key, list.type_name());
  check_order(key, list.size());
  std::vector<Row> rows;
  for (std::size_t i = 0; i < list.size(); ++i)
    rows.push_back(
        numbers(list[i], fmt::format("{}[{}]", key, i), list.size(), fmt::format("{} has {} rows", key, list.size())));
  return rows;
}

Row right_side(const json& list, const std::string& key, std::size_t n) {
  return numbers(list, key, n, fmt::format("the order is {}", n));
}

void check_keys(const json& document) {
  const std::vector<std::string> hlcp = {"A_plus", "A_minus", "b"}, lcp = {"M", "q"};
  if (!document.is_object()) refuse("is not a problem: {}", forms);
  const auto has = [&](const std::string& key) { return document.contains(key); };
  for (const auto& [key, value] : document.items()) {
    if (std::count(hlcp.begin(), hlcp.end(), key) + std::count(lcp.begin(), lcp.end(), key) == 0)
      refuse("unknown key {}{}", io::quote(key), io::suggestion(key, {"A_plus", "A_minus", "b", "M", "q"}));
  }
  const auto first = std::find_if(hlcp.begin(), hlcp.end(), has), second = std::find_if(lcp.begin(), lcp.end(), has);
  if (first == hlcp.end() && second == lcp.end()) refuse("is not a problem: {}", forms);
  if (first != hlcp.end() && second != lcp.end()) refuse("has both {} and {}: {}", *first, *second, forms);
  for (const std::string& key : first != hlcp.end() ? hlcp : lcp)
    if (!has(key)) refuse("has no {}: {}", key, forms);
}

void read_json(const std::string& text, HlcpProblem& problem) {
  const json document = parse(text);
  check_keys(document);
  problem.is_lcp = document.contains("M");
  if (problem.is_lcp) {
    const std::vector<Row> m = matrix(document["M"], "M");
    problem.n = static_cast<int>(m.size());
    return enter_lcp(problem, m, right_side(document["q"], "q", m.size()));
  }
  const std::vector<Row> plus = matrix(document["A_plus"], "A_plus"), minus = matrix(document["A_minus"], "A_minus");
  if (plus.size() != minus.size())
    refuse("A_plus has {} rows and A_minus {}: write matrices of one order", plus.size(), minus.size());
  const Row b = right_side(document["b"], "b", plus.size());
  problem.n = static_cast<int>(plus.size());
  for (std::size_t i = 0; i < b.size(); ++i) {
    std::copy(plus[i].begin(), plus[i].end(), problem.data.plus[i]);
    std::copy(minus[i].begin(), minus[i].end(), problem.data.minus[i]);
    problem.data.b[i] = b[i];
  }
}

// ---- Siconos

/// Numbers between blanks, with the lines they are in.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : text_(text) {}

  double next(const std::string& what) {
    skip_blanks();
    if (text_.empty()) refuse("ends before {}; {}", what, layout);
    const std::string_view word = text_.substr(0, text_.find_first_of(blanks));
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = end == word.data() + word.size();
    if (whole && (error == std::errc::result_out_of_range || !std::isfinite(value)))
      refuse_line(line_, "{} is {}, beyond the range of doubles", what, io::quote(word));
    if (!whole || error != std::errc()) refuse_line(line_, "{} must be a number, not {}", what, io::quote(word));
    text_.remove_prefix(word.size());
    return value;
  }

  long line() const { return line_; }

  static constexpr const char* layout = "a Siconos file has n, 0, n, n, n, n, then M column by column, then q";

 private:
  void skip_blanks() {
    const std::size_t end = std::min(text_.find_first_not_of(blanks), text_.size());
    line_ += std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    text_.remove_prefix(end);
  }

  static constexpr std::string_view blanks = " \t\r\n";
  std::string_view text_;
  long line_ = 1;
};

/// What linearComplementarity_printInFile of Siconos writes: the order, the matrix' storage type (0, dense), its rows
/// and columns twice, its entries column by column, q; then remarks may follow.
void read_siconos(std::string_view text, HlcpProblem& problem) {
  Numbers numbers(text);
  const double order = numbers.next("n");
  if (!(order >= 1 && order <= hlcp_max_order) || order != std::floor(order))
    refuse_line(numbers.line(), "n is {}; the kernel takes orders 1 to {}", order, hlcp_max_order);
  const double storage = numbers.next("the storage type");
  if (storage != 0.0)
    refuse_line(numbers.line(), "the storage type is {}, not 0 (dense); {}", storage, Numbers::layout);
  for (const char* size : {"rows", "columns", "rows", "columns"}) {
    const double count = numbers.next(fmt::format("the number of {} of M", size));
    if (count != order)
      refuse_line(numbers.line(), "M has {} {}, and n is {}; {}", count, size, order, Numbers::layout);
  }
  const auto n = static_cast<std::size_t>(order);
  std::vector<Row> m(n, Row(n));
  Row q;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) m[i][j] = numbers.next(fmt::format("M[{}][{}]", i, j));
  for (std::size_t i = 0; i < n; ++i) q.push_back(numbers.next(fmt::format("q[{}]", i)));
  problem.is_lcp = true;
  problem.n = static_cast<int>(n);
  enter_lcp(problem, m, q);
}

bool is_siconos(const std::string& file, const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool starts_with_digit = first != text.npos && text[first] >= '0' && text[first] <= '9';
  return file.ends_with(".dat") || starts_with_digit;
}

}  // namespace

HlcpReading parse_hlcp(const std::string& text, const std::string& file) {
  HlcpReading reading{HlcpProblem{}, ""};
  reading.problem->file = file;
  reading.problem->hash = io::fnv1a(text);
  try {
    is_siconos(file, text) ? read_siconos(text, *reading.problem) : read_json(text, *reading.problem);
  } catch (const Defect& defect) {
    return {std::nullopt, file + defect.what()};
  }
  return reading;
}

std::optional<HlcpProblem> read_hlcp(const std::string& file) {
  const io::FileText read = io::read_text(file, most_bytes);
  if (!read.problem.empty()) {
    complain("{}: {}", file, read.problem);
    return std::nullopt;
  }
  HlcpReading reading = parse_hlcp(read.text, file);
  if (!reading.problem) complain(reading.defect);
  return std::move(reading.problem);
}

}  // namespace slideway::app
