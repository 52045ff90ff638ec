// slideway hlcp: one problem A+ x+ - A- x- = b, the kernel's answer beside all exact solutions.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <slideway/io/json.hpp>
#include <slideway/properties/hlcp_shrink.hpp>

#include "hlcp_problem.hpp"
#include "messages.hpp"
#include "output.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

using properties::describe, properties::HlcpCase, properties::HlcpCheck;

/// Fractions beyond this length are of no use to a reader.
constexpr std::size_t longest_fraction = 24;

std::string exact_number(const oracle::Rational& value) {
  const std::string decimal = fmt::format("{:.17g}", oracle::nearest_double(value));
  const std::string fraction = value.str();
  if (fraction.size() > longest_fraction) return decimal;
  return fraction == decimal ? fraction : fmt::format("{} = {}", fraction, decimal);
}

/// Three columns: what, the kernel's, the exact one.
class Table {
 public:
  void row(std::string_view what, std::string_view kernel, std::string_view exact) {
    std::string line = fmt::format("{:<15}{:<25}{}", what, kernel, exact);
    line.erase(line.find_last_not_of(' ') + 1);
    text_ += line + '\n';
  }
  void line(std::string_view what, std::string_view text) { text_ += fmt::format("{:<15}{}\n", what, text); }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

/// Solutions, or vertices of continua; the kernel's x beside the one that is nearest to it.
void add_exact(Table& table, const HlcpCheck& check, const std::vector<oracle::Exact>& list, const char* title,
               int beside) {
  constexpr std::size_t most = 8;
  for (std::size_t s = 0; s < std::min(most, list.size()); ++s) {
    if (list.size() > 1 || title[0] == 'v') table.row("", "", fmt::format("{} {} of {}", title, s + 1, list.size()));
    for (std::size_t k = 0; k < list[s].size(); ++k) {
      const bool both = static_cast<int>(s) == beside;
      table.row(fmt::format("x[{}]", k), both ? fmt::format("{:.17g}", check.answer.x[k]) : "",
                exact_number(list[s][k]));
    }
  }
  if (list.size() > most) table.row("", "", fmt::format("and {} more: --json FILE has all", list.size() - most));
}

void add_kernel(Table& table, const HlcpProblem& problem, const HlcpCheck& check) {
  for (int k = 0; k < problem.n; ++k) table.row(fmt::format("x[{}]", k), fmt::format("{:.17g}", check.answer.x[k]), "");
}

double digits(const HlcpCheck& check) { return -std::log10(check.distance); }

std::string table_of(const HlcpProblem& problem, const HlcpCheck& check) {
  Table table;
  table.line("problem",
             fmt::format("{}: {} of order {}", problem.file,
                         problem.is_lcp ? "LCP w - M z = q, x = w - z," : "HLCP A+ x+ - A- x- = b", problem.n));
  table.row("", "kernel", "exact");
  table.row("answer", name(check.answer.status), check.exact ? describe(*check.exact) : "not sought");
  table.row("uniqueness", name(check.answer.uniqueness),
            !check.exact              ? ""
            : check.exact->w_property ? "W-property holds"
                                      : "W-property does not hold");
  table.row("solves", fmt::format("{}", check.answer.solves), "");
  if (check.solved())
    table.row("residual", fmt::format("{:.3g}", check.answer.residual),
              fmt::format("{:.3g} of this x", check.residual));
  const bool beside = check.nearest >= 0 && check.nearest < 8;
  if (check.solved() && !beside) add_kernel(table, problem, check);
  if (check.exact) {
    add_exact(table, check, check.exact->isolated, "solution", beside ? check.nearest : -1);
    add_exact(table, check, check.exact->continuum, "vertex", -1);
  }
  if (check.nearest >= 0)
    table.line("digits shared", check.distance == 0 ? "all" : fmt::format("{:.1f}", digits(check)));
  table.line("verdict", check.verdict);
  return std::move(table).text();
}

io::Json solutions_of(const std::vector<oracle::Exact>& solutions) {
  io::Json list = io::Json::array();
  for (const oracle::Exact& solution : solutions) {
    io::Json exact = io::Json::array(), rounded = io::Json::array();
    for (const oracle::Rational& value : solution) {
      exact.push_back(value.str());
      rounded.push_back(oracle::nearest_double(value));
    }
    list.push_back({{"exact", exact}, {"double", rounded}});
  }
  return list;
}

/// {key: list of f(x_k)}, null where the kernel has no x.
template <class Part>
io::Json vector_of(const HlcpProblem& problem, const HlcpCheck& check, Part part) {
  if (!check.solved()) return nullptr;
  io::Json list = io::Json::array();
  for (int k = 0; k < problem.n; ++k) list.push_back(part(check.answer.x[k]));
  return list;
}

io::Json document_of(const HlcpProblem& problem, const HlcpCheck& check) {
  const auto& kernel = check.answer;
  io::Json json{{"format", io::json_format},
                {"version", SLIDEWAY_VERSION},
                {"problem", problem.file},
                {"hash", problem.hash},
                {"kind", problem.is_lcp ? "lcp" : "hlcp"},
                {"order", problem.n},
                {"status", name(kernel.status)}};
  json["x"] = vector_of(problem, check, [](double x) { return x; });
  if (problem.is_lcp) {
    json["z"] = vector_of(problem, check, [](double x) { return x < 0.0 ? -x : 0.0; });
    json["w"] = vector_of(problem, check, [](double x) { return x > 0.0 ? x : 0.0; });
  }
  json["solves"] = kernel.solves;
  json["residual"] = check.solved() ? io::Json(kernel.residual) : io::Json(nullptr);
  json["uniqueness"] = name(kernel.uniqueness);
  json["w_property"] = check.exact ? io::Json(check.exact->w_property) : io::Json(nullptr);
  json["solutions"] = check.exact ? solutions_of(check.exact->isolated) : io::Json(nullptr);
  json["continuum"] = check.exact ? io::Json(!check.exact->continuum.empty()) : io::Json(nullptr);
  json["distance"] = check.nearest >= 0 ? io::Json(check.distance) : io::Json(nullptr);
  json["agree"] = check.agree();
  json["verdict"] = check.verdict;
  return json;
}

/// A smaller problem with the same answer and the same verdict.
HlcpCase smaller(const HlcpProblem& problem, const HlcpCheck& check) {
  return shrink(HlcpCase(problem), [&](const HlcpCase& tried) {
    const properties::HlcpAnswer answer = kernel_answer(tried);
    if (answer.status != check.answer.status || answer.uniqueness != check.answer.uniqueness) return false;
    const HlcpCheck other = check_hlcp(tried, answer);
    return other.judgement == check.judgement &&
           (!check.exact || !other.exact || other.exact->count() == check.exact->count());
  });
}

struct HlcpCommand {
  std::string problem, json, shrink;
};

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

int hlcp(const HlcpCommand& command) {
  const auto problem = read_hlcp(command.problem);
  if (!problem) return bad_input;
  if (is_same_file(command.json, command.problem)) {
    complain("{}: is the problem itself: write to another file", command.json);
    return bad_input;
  }
  if (is_same_file(command.shrink, command.problem)) {
    complain("{}: is the problem itself: write to another file", command.shrink);
    return bad_input;
  }
  Output json(command.json), shrunk(command.shrink);
  if (!open_all({&json, &shrunk}, "")) return bad_input;
  const HlcpCheck check = check_hlcp(*problem, properties::kernel_answer(*problem));
  fmt::print(json.standard() || shrunk.standard() ? stderr : stdout, "{}", table_of(*problem, check));
  json.write(io::text(document_of(*problem, check)));
  if (shrunk.wanted()) shrunk.write(properties::json(smaller(*problem, check)) + "\n");
  if (!json.close() || !shrunk.close()) return bad_input;
  return check.agree() ? good : refused;
}

}  // namespace

void add_hlcp(CLI::App& command, int& status) {
  const auto options = std::make_shared<HlcpCommand>();
  CLI::App* verb =
      command.add_subcommand("hlcp", "Solve one problem A+ x+ - A- x- = b, and hold the answer against all exact ones");
  verb->add_option("PROBLEM", options->problem,
                   "JSON with A_plus, A_minus, b or with M, q; a Siconos LCP file; - for standard input")
      ->required();
  verb->add_option("--json", options->json, "Write the answers as JSON; - is standard output");
  verb->add_option(
      "--shrink", options->shrink,
      "Write the smallest problem found that has the same answer and verdict, as JSON; - is standard output");
  verb->callback([options, &status] { status = hlcp(*options); });
}

}  // namespace slideway::app
