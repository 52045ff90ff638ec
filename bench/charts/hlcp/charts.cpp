#include "charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "peers.hpp"

namespace slideway::charts {
namespace {

bool is_kernel(const HlcpMeasured& m) { return m.solver == kernel_solver; }

/// Is it what a user of that solver pays: with the conversion, where there is one to pay?
bool is_whole(const HlcpBoard& board, const HlcpMeasured& m) {
  if (is_kernel(m)) return true;
  const auto& families = board.families();
  const auto family =
      std::find_if(families.begin(), families.end(), [&](const HlcpFamily& one) { return one.name == m.family; });
  return family->is_lcp == (m.conversion == Conversion::none);
}

const HlcpMeasured* find(const HlcpBoard& board, const std::string& family, int n, const std::string& solver,
                         bool warm) {
  for (const HlcpMeasured& m : board.measured) {
    if (m.family == family && m.n == n && m.solver == solver && m.warm == warm && is_whole(board, m)) return &m;
  }
  return nullptr;
}

/// Of one family, or of all where it is empty: the geometric mean of what a solve takes; 0 if the solver was not right
/// in every problem.
double mean_ns(const HlcpBoard& board, const std::string& only, int n, const std::string& solver, bool warm) {
  double logarithms = 0;
  int families = 0;
  for (const HlcpFamily& family : board.families()) {
    if (!only.empty() && family.name != only) continue;
    const HlcpMeasured* m = find(board, family.name, n, solver, warm);
    if (m == nullptr || m->ns == 0) return 0;
    logarithms += std::log(m->ns);
    ++families;
  }
  return std::exp(logarithms / families);
}

/// Over all orders of one family, or of all.
Verdicts total(const HlcpBoard& board, const std::string& only, const std::string& solver, bool warm) {
  Verdicts sum;
  for (const HlcpMeasured& m : board.measured) {
    if (m.solver != solver || m.warm != warm || !is_whole(board, m)) continue;
    if (!only.empty() && m.family != only) continue;
    sum.right += m.verdicts.right;
    sum.refused += m.verdicts.refused;
    sum.wrong += m.verdicts.wrong;
  }
  return sum;
}

int count(const Verdicts& verdicts) { return verdicts.right + verdicts.refused + verdicts.wrong; }

/// A line of the chart.
struct Shown {
  std::string family;  ///< empty: the mean over all
  std::string solver;
  bool warm;
  std::string name;
  Style style;
};

/// Of Siconos' solvers those that differ; the numbers have all.
std::vector<Shown> solver_lines() {
  return {{"", kernel_solver, true, "slideway, right signs", {0, 0, false}},
          {"", kernel_solver, false, "slideway, from +", {1, 1, false}},
          {"", lexicolemke, false, "lexicolemke", {7, 2, true}},
          {"", "pivot, least index", false, "pivot, least index", {3, 3, true}},
          {"", "pivot, Bard", false, "pivot, Bard", {2, 5, true}},
          {"", "PGS", true, "PGS, near", {4, 4, true}},
          {"", "Newton-min", false, "Newton-min", {5, 2, true}},
          {"", "Newton-FB", false, "Newton-FB", {6, 4, true}},
          {"", "enumeration", false, "enumeration", {6, 5, true}}};
}

/// The kernel and lexicolemke, family by family: what is hard for one is easy for another.
std::vector<Shown> family_lines(const HlcpBoard& board) {
  std::vector<Shown> lines;
  for (const HlcpFamily& family : board.families()) {
    const int place = static_cast<int>(lines.size() / 2);
    lines.push_back({family.name, kernel_solver, false, family.name, {place, place, false}});
    lines.push_back({family.name, lexicolemke, false, "lexicolemke", {place, place, true}});
  }
  return lines;
}

/// Whose success was none, in how many problems.
std::string wrong_in_silence(const HlcpBoard& board) {
  std::string who;
  for (const LcpSolver& solver : lcp_solvers()) {
    const int wrong = total(board, "", solver.name, false).wrong;
    if (wrong > 0) who += fmt::format("{}{} {}", who.empty() ? "" : ", ", solver.name, wrong);
  }
  return who.empty() ? "nobody" : who;
}

io::Json json(const Verdicts& verdicts) {
  return {{"right", verdicts.right}, {"refused", verdicts.refused}, {"wrong_in_silence", verdicts.wrong}};
}

double ratio(const HlcpMeasured* theirs, const HlcpMeasured* ours) {
  return theirs != nullptr && ours != nullptr && ours->ns > 0 ? theirs->ns / ours->ns : 0;
}

struct Bar {
  int n;
  double warm;  ///< times faster than lexicolemke, from the right signs
};
constexpr Bar warm_bars[] = {{2, 10}, {4, 6}, {8, 9}, {16, 18}};
constexpr double cold_bar = 1.5, hard_bar = 1;

std::string bar_line(const HlcpBoard& board, const std::string& family, int n, bool warm, double least) {
  const HlcpMeasured* ours = find(board, family, n, kernel_solver, warm);
  const HlcpMeasured* theirs = find(board, family, n, lexicolemke, false);
  const double times = ratio(theirs, ours);
  std::string verdict = times >= least ? "held" : "MISSED";
  if (ours == nullptr || ours->ns == 0) {
    verdict = "MISSED: not every answer is right";
  } else if (theirs == nullptr) {
    verdict = "missing: Siconos";
  } else if (theirs->ns == 0) {
    verdict = fmt::format("no ratio: lexicolemke right in {} of {}", theirs->verdicts.right, count(theirs->verdicts));
  }
  return fmt::format("{:9s} {:16s} n = {:2d} {:11s} {:9.1f} ns {:9.1f} ns {:7.2f} x, at least {:4.1f}: {}", board.name,
                     family, n, warm ? "right signs" : "from +", ours != nullptr ? ours->ns : 0,
                     theirs != nullptr ? theirs->ns : 0, times, least, verdict);
}

}  // namespace

std::vector<HlcpBoard> hlcp_boards() {
  return {{"hlcp_kind", "A+ x+ − A− x− = b as mechanisms give it", kind_families, false, {}},
          {"hlcp_hard", "Hard LCPs: slideway from +, and lexicolemke", hard_families, true, {}}};
}

Chart hlcp_chart(const HlcpBoard& board) {
  Chart chart;
  chart.title = board.title;
  chart.subtitle = lcp_solvers().empty() ? "missing: Siconos"
                                         : fmt::format("dashed: Siconos; (right / refused / wrong in silence: {})",
                                                       wrong_in_silence(board));
  chart.x = {"order n", 1.8, 36, true};
  double least = HUGE_VAL, most = 0;
  for (const Shown& one : board.by_family ? family_lines(board) : solver_lines()) {
    const Verdicts verdicts = total(board, one.family, one.solver, one.warm);
    if (count(verdicts) == 0) continue;
    Line line{fmt::format("{} ({} / {} / {})", one.name, verdicts.right, verdicts.refused, verdicts.wrong),
              one.style,
              {},
              {}};
    for (const int n : hlcp_orders) {
      const double ns = mean_ns(board, one.family, n, one.solver, one.warm);
      if (ns == 0) continue;
      line.points.push_back({static_cast<double>(n), ns});
      least = std::min(least, ns);
      most = std::max(most, ns);
    }
    chart.lines.push_back(std::move(line));
  }
  chart.y = {"ns per solve", std::pow(10, std::floor(std::log10(least))), std::pow(10, std::ceil(std::log10(most))),
             true};
  return chart;
}

io::Json document(const HlcpBoard& board) {
  io::Json all = {{"chart", board.name},         {"siconos", !lcp_solvers().empty()},
                  {"tolerance", hlcp_tolerance}, {"families", io::Json::array()},
                  {"counts", io::Json::array()}, {"measured", io::Json::array()},
                  {"bars", bars(board)}};
  for (const HlcpFamily& family : board.families())
    all["families"].push_back({{"name", family.name}, {"what", family.what}, {"lcp", family.is_lcp}});
  std::vector<std::string> solvers = {kernel_solver};
  for (const LcpSolver& solver : lcp_solvers()) solvers.push_back(solver.name);
  for (const std::string& solver : solvers) {
    for (const bool warm : {false, true}) {
      const Verdicts verdicts = total(board, "", solver, warm);
      if (count(verdicts) == 0) continue;
      io::Json row = {{"solver", solver}, {"warm", warm}};
      row.update(json(verdicts));
      all["counts"].push_back(row);
    }
  }
  for (const HlcpMeasured& m : board.measured) {
    io::Json row = {{"family", m.family},
                    {"n", m.n},
                    {"solver", m.solver},
                    {"warm", m.warm},
                    {"with_conversion", m.conversion == Conversion::of_theirs}};
    row.update(json(m.verdicts));
    if (is_kernel(m)) {
      row["certified"] = m.certified;
      row["solves"] = m.solves;
    }
    if (m.ns > 0) {
      row["ns"] = m.ns;
      row["ns_least"] = m.ns_low;
      row["ns_most"] = m.ns_high;
      if (!is_kernel(m)) {
        const HlcpMeasured* warm = find(board, m.family, m.n, kernel_solver, true);
        const HlcpMeasured* cold = find(board, m.family, m.n, kernel_solver, false);
        row["times_slideway_right_signs"] = ratio(&m, warm);
        row["times_slideway_from_plus"] = ratio(&m, cold);
      }
    }
    all["measured"].push_back(row);
  }
  return all;
}

std::vector<std::string> bars(const HlcpBoard& board) {
  std::vector<std::string> lines;
  const bool hard = board.name == "hlcp_hard";
  for (const HlcpFamily& family : board.families()) {
    for (const int n : hlcp_orders) {
      const Bar* bar = std::find_if(std::begin(warm_bars), std::end(warm_bars), [&](const Bar& b) { return b.n == n; });
      if (!hard && bar != std::end(warm_bars)) lines.push_back(bar_line(board, family.name, n, true, bar->warm));
      lines.push_back(bar_line(board, family.name, n, false, hard ? hard_bar : cold_bar));
    }
  }
  return lines;
}

}  // namespace slideway::charts
